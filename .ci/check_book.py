#!/usr/bin/env python3
"""Looks at the links of the pages that users read, and of the built book if there is one.

    python3 .ci/check_book.py [BOOK]

Every relative link of the sources leads to a file, and to a heading of it where it has an anchor; every page of `docs` stands in
`docs/SUMMARY.md` once. In BOOK, the folder that `mdbook build` wrote, every relative link leads to a file in it or to one of
the sources, and every anchor to an element. Nothing is asked from the network. Exit code 1 and a line for each fault.
"""

import re
import sys
import unicodedata
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parents[1]
PAGES = [*ROOT.glob("*.md"), *sorted((ROOT / "docs").rglob("*.md")), ROOT / "python/README.md", ROOT / "studies/README.md"]
LINK = re.compile(r"!?\[(?:[^\[\]]|\[[^\]]*\])*\]\(([^()\s]+(?:\([^()]*\))?)(?:\s+\"[^\"]*\")?\)")
FENCED = re.compile(r"^\s*```.*?^\s*```\s*$", re.DOTALL | re.MULTILINE)


def anchors(text):
    """The anchors that GitHub and mdBook give the headings of a page."""
    found = set()
    for heading in re.findall(r"^#+ +(.*?) *$", FENCED.sub("", text), re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        kept = "".join(letter for letter in words if letter in "-_ " or unicodedata.category(letter)[0] in "LN")
        anchor = base = kept.strip().replace(" ", "-")
        number = 0
        while anchor in found:
            number += 1
            anchor = f"{base}-{number}"
        found.add(anchor)
    return found


def is_relative(link):
    return not re.match(r"[a-z]+:|//", link)


def of_sources():
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        place = page.relative_to(ROOT)
        for link in LINK.findall(re.sub(r"(?<!`)`[^`\n]+`(?!`)", "`", FENCED.sub("", text))):
            if not is_relative(link):
                continue
            name, _, anchor = unquote(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            if not target.exists():
                yield f"{place}: {link} leads nowhere"
            elif anchor and target.suffix == ".md" and anchor not in anchors(target.read_text(encoding="utf-8")):
                yield f"{place}: {link}: there is no such heading"
    listed = re.findall(r"\]\(([^)]+)\)", (ROOT / "docs/SUMMARY.md").read_text(encoding="utf-8"))
    for name in {name for name in listed if listed.count(name) > 1}:
        yield f"docs/SUMMARY.md: {name} stands there more than once"
    for page in sorted((ROOT / "docs").rglob("*.md")):
        name = str(page.relative_to(ROOT / "docs"))
        if name not in listed and name != "SUMMARY.md":
            yield f"docs/{name} does not stand in docs/SUMMARY.md"


class Elements(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.names, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for key, value in attributes:
            if key in ("id", "name") and value:
                self.names.add(value)
            elif key in ("href", "src") and value and tag != "base":
                self.links.append(value)


def of_book(book):
    pages = {page: Elements(page.read_text(encoding="utf-8")) for page in book.rglob("*.html")}
    # One page holds all others again, for printing; another is for addresses that do not exist.
    for page, elements in sorted(pages.items()):
        if page.name in ("print.html", "404.html", "toc.html"):
            continue
        for link in elements.links:
            if not is_relative(link):
                continue
            name, _, anchor = unquote(link).partition("#")
            target = (page.parent / name).resolve() if name else page
            place = page.relative_to(book)
            if not target.is_relative_to(book):
                # A file of the sources, which lie around the book.
                source = ROOT / "docs" / page.relative_to(book).parent / name
                if not source.resolve().exists():
                    yield f"{book.name}/{place}: {link} leads nowhere"
            elif not target.exists():
                yield f"{book.name}/{place}: {link} leads nowhere"
            elif anchor and target in pages and anchor not in pages[target].names:
                yield f"{book.name}/{place}: {link}: there is no such element"


def main():
    faults = list(of_sources())
    if len(sys.argv) > 1:
        faults += of_book(Path(sys.argv[1]).resolve())
    print("\n".join(faults) if faults else "all links of the book lead somewhere")
    sys.exit(bool(faults))


if __name__ == "__main__":
    main()
