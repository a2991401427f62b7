"""Opens pages in a headless Chromium, at three sizes, in light and dark, and on paper, and names what is wrong with them.

    python tests/browser/check.py PAGE.html ... [--shots DIR] [--browser PATH] [--expect-faults]

Looked for: messages on the console, failed requests and requests beyond `file:`, images without alternative text or
without a picture, charts without a title, anchors and links that lead nowhere, sideways scrolling, identifiers that are
there twice, headings out of order, text too small or too pale to read, paper without pages. With `--shots` the pages are
also written as PNG (whole and first view) and PDF. Exit code 1 if there is anything to name. `--expect-faults` turns it
round: every kind of fault in FAULTS must be found, so that a check that has gone blind is noticed.
"""

import argparse
import sys
from pathlib import Path
from urllib.parse import unquote, urlsplit

from playwright.sync_api import sync_playwright

SIZES = [(1280, 900), (768, 1024), (360, 740)]

# What `faulty.html` does wrong, as the findings begin.
FAULTS = [
    "console: ",
    "script: ",
    "request beyond the file",
    "image without alt",
    "image without a picture",
    "chart without a title",
    "picture not cut off",
    "identifier twice",
    "link to #nowhere",
    "link to missing.csv",
    "heading of level 2",
    "no language",
    "no title",
    "scrolls sideways",
    "contrast ",
]

# Everything that can be read off the document in place; returns a list of findings.
LOOK = """
() => {
  const found = [];
  const all = (selector) => Array.from(document.querySelectorAll(selector));
  const shown = (element) => element.getClientRects().length > 0;
  const words = (element) => (element.outerHTML || "").slice(0, 90);

  for (const image of all("img")) {
    if (!image.hasAttribute("alt")) found.push(`image without alt: ${words(image)}`);
    if (image.complete && image.naturalWidth === 0) found.push(`image without a picture: ${words(image)}`);
  }
  for (const svg of all("svg[role=img]")) {
    const title = svg.querySelector(":scope > title");
    const label = svg.getAttribute("aria-label");
    if (!(title && title.textContent.trim()) && !(label && label.trim())) found.push(`chart without a title: ${words(svg)}`);
  }
  for (const inner of all("svg svg[overflow=hidden]")) {
    if (getComputedStyle(inner).overflowX === "visible") found.push(`picture not cut off at its frame: ${words(inner)}`);
  }
  const ids = new Map();
  for (const element of all("[id]")) ids.set(element.id, (ids.get(element.id) || 0) + 1);
  for (const [id, count] of ids) if (count > 1) found.push(`identifier ${id} is there ${count} times`);
  for (const attribute of ["aria-labelledby", "aria-describedby", "for"]) {
    for (const element of all(`[${attribute}]`)) {
      for (const id of element.getAttribute(attribute).split(/\\s+/)) {
        if (id && !ids.has(id)) found.push(`${attribute} names ${id}, which is not there`);
      }
    }
  }
  for (const link of all("a[href^='#']")) {
    const id = decodeURIComponent(link.getAttribute("href").slice(1));
    if (id && !ids.has(id)) found.push(`link to #${id}, which is not there`);
  }
  let level = 0;
  for (const heading of all("h1, h2, h3, h4, h5, h6")) {
    const own = Number(heading.tagName[1]);
    if (own > level + 1) found.push(`heading of level ${own} after one of level ${level}: ${heading.textContent.trim()}`);
    if (!heading.textContent.trim()) found.push("empty heading");
    level = own;
  }
  if (all("h1").length !== 1) found.push(`${all("h1").length} headings of level 1`);
  if (!document.documentElement.lang) found.push("no language");
  if (!document.title.trim()) found.push("no title");
  if (all("main").length !== 1) found.push(`${all("main").length} main landmarks`);

  const room = document.scrollingElement;
  if (room.scrollWidth > innerWidth) {
    const inside = (element) => {
      for (let box = element.parentElement; box; box = box.parentElement) {
        if (["auto", "scroll", "hidden", "clip"].includes(getComputedStyle(box).overflowX)) return true;
      }
      return false;
    };
    const wide = all("body *").filter((e) => shown(e) && e.getBoundingClientRect().right > innerWidth + 0.5 && !inside(e));
    found.push(`scrolls sideways: ${room.scrollWidth} px in ${innerWidth}: ${wide.slice(0, 3).map(words).join(" | ")}`);
  }

  // Contrast of text on its background (WCAG 2, 1.4.3) and its size; text inside charts is scaled and left out.
  const channel = (c) => (c /= 255) <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  const colour = (text) => (text.match(/[\\d.]+/g) || []).map(Number);
  const light = ([r, g, b]) => 0.2126 * channel(r) + 0.7152 * channel(g) + 0.0722 * channel(b);
  const background = (element) => {
    for (let box = element; box; box = box.parentElement) {
      const [r, g, b, a = 1] = colour(getComputedStyle(box).backgroundColor);
      if (a > 0.5) return [r, g, b];
    }
    return [255, 255, 255];
  };
  const seen = new Set();
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const element = node.parentElement;
    if (!node.textContent.trim() || !shown(element) || element.closest("svg, script, style, noscript, option")) continue;
    const style = getComputedStyle(element);
    const [a, b] = [light(colour(style.color)), light(background(element))].sort((x, y) => y - x);
    const ratio = (a + 0.05) / (b + 0.05);
    const name = `${element.tagName.toLowerCase()}.${element.className}`;
    if (ratio < 4.5 && !seen.has(name) && !element.closest(":disabled")) {
      seen.add(name);
      found.push(`contrast ${ratio.toFixed(2)} of ${name}: ${node.textContent.trim().slice(0, 40)}`);
    }
    if (parseFloat(style.fontSize) < 9 && !seen.has(name)) {
      seen.add(name);
      found.push(`text of ${style.fontSize} in ${name}: ${node.textContent.trim().slice(0, 40)}`);
    }
  }
  return found;
}
"""


def look(page, path):
    """What is wrong with the page as it stands."""
    found = page.evaluate(LOOK)
    hrefs = page.eval_on_selector_all("a[href]", "links => links.map(link => link.getAttribute('href'))")
    for href in sorted(set(hrefs)):
        parts = urlsplit(href)
        if parts.scheme or parts.netloc:
            # A source may be cited; the page itself must not need it.
            if parts.scheme not in ("http", "https"):
                found.append(f"link of an unknown kind: {href}")
        elif parts.path and not (path.parent / unquote(parts.path)).is_file():
            found.append(f"link to {href}, which is no file beside the page")
    # Lazy frames load when they come into view.
    for frame in page.query_selector_all("iframe"):
        # A folded one has no height before it is unfolded.
        frame.evaluate("frame => { const folded = frame.closest('details'); if (folded) folded.open = true; }")
        frame.scroll_into_view_if_needed()
        page.wait_for_timeout(400)
        inside = frame.content_frame()
        if inside is None or not inside.evaluate("document.body && document.body.children.length > 0"):
            found.append(f"empty frame: {frame.get_attribute('title')}")
            continue
        hidden = inside.evaluate("document.scrollingElement.scrollHeight - innerHeight")
        if hidden > 4:
            found.append(f"frame {frame.get_attribute('title')!r} hides {hidden} px of its height")
        if inside.evaluate("document.scrollingElement.scrollWidth > innerWidth"):
            found.append(f"frame {frame.get_attribute('title')!r} scrolls sideways")
        frame.evaluate("frame => { const unfolded = frame.closest('details'); if (unfolded) unfolded.open = false; }")
    page.evaluate("scrollTo(0, 0)")
    return found


def sort(page):
    """Whether tables can be sorted by their columns, and come back as they were."""
    return page.evaluate(
        """
        () => {
          const found = [];
          for (const table of document.querySelectorAll("main table:has(thead button)")) {
            const body = table.tBodies[0];
            const before = body.innerText;
            const button = table.querySelector("thead .number button") || table.querySelector("thead button");
            const heading = button.closest("th");
            button.click();
            if (!heading.hasAttribute("aria-sort")) found.push(`a heading that does not say that it sorts: ${heading.textContent}`);
            button.click();
            button.click();
            if (body.innerText !== before) found.push(`a table that does not come back: ${heading.textContent}`);
          }
          return found;
        }
        """
    )


def open_page(browser, path, size, shots, scheme="light"):
    """Everything wrong with one page at one size, for eyes that want light or dark pages."""
    found = []
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
    page.on("console", lambda message: message.type in ("error", "warning") and found.append(f"console: {message.text}"))
    page.on("pageerror", lambda error: found.append(f"script: {error}"))
    page.on("requestfailed", lambda request: found.append(f"request failed: {request.url[:90]}"))

    def requested(request):
        # What a page makes itself, such as the script of its own thread, is a blob.
        if urlsplit(request.url).scheme not in ("file", "data", "about", "blob"):
            found.append(f"request beyond the file: {request.url[:90]}")

    page.on("request", requested)
    page.goto(path.as_uri(), wait_until="load")
    page.wait_for_timeout(150)
    found += look(page, path)
    name = f"{path.parent.name}-{path.stem}-{size[0]}{'' if scheme == 'light' else '-dark'}"
    if shots:
        page.screenshot(path=shots / f"{name}-view.png")
        page.screenshot(path=shots / f"{name}.png", full_page=True)
    if size == SIZES[0] and scheme == "light":
        found += [f"sorted: {finding}" for finding in sort(page)]
        # What is folded must be sound too.
        page.evaluate("document.querySelectorAll('details').forEach(details => { details.open = true; })")
        found += [f"unfolded: {finding}" for finding in look(page, path) if finding not in found]
        page.evaluate("document.querySelectorAll('main details').forEach(details => { details.open = false; })")
        for paper in ("A4", "Letter"):
            pdf = page.pdf(format=paper, prefer_css_page_size=False)
            # Every page is an object of this type; catalogues of pages are another.
            if pdf.count(b"/Type /Page\n") + pdf.count(b"/Type /Page ") + pdf.count(b"/Type /Page/") < 1:
                found.append(f"no pages on {paper} paper")
            if shots:
                (shots / f"{name}-{paper}.pdf").write_bytes(pdf)
    page.close()
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("pages", nargs="+", type=Path)
    parser.add_argument("--shots", type=Path, help="folder for pictures of the pages")
    parser.add_argument("--expect-faults", action="store_true", help="fail unless every known kind of fault is found")
    parser.add_argument("--browser", default="/usr/bin/chromium", help="path of Chromium")
    arguments = parser.parse_args()
    if arguments.shots:
        arguments.shots.mkdir(parents=True, exist_ok=True)
    findings = []
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=arguments.browser, args=["--no-sandbox"])
        for page in arguments.pages:
            path = page.resolve()
            for size in SIZES:
                for scheme in ("light", "dark") if size == SIZES[0] else ("light",):
                    for finding in open_page(browser, path, size, arguments.shots, scheme):
                        findings.append(finding)
                        if not arguments.expect_faults:
                            print(f"{page} at {size[0]}, {scheme}: {finding}")
        browser.close()
    if arguments.expect_faults:
        unseen = [fault for fault in FAULTS if not any(finding.startswith(fault) for finding in findings)]
        print(f"faults not seen: {unseen}" if unseen else f"{len(FAULTS)} kinds of faults: all seen")
        return 1 if unseen else 0
    if findings:
        print(f"{len(findings)} findings on {len(arguments.pages)} pages")
        return 1
    print(f"{len(arguments.pages)} pages at {len(SIZES)} sizes and on paper: nothing to find fault with")
    return 0


if __name__ == "__main__":
    sys.exit(main())
