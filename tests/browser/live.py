"""Tries pages of `apportion live` in a headless Chromium against the program.

    python tests/browser/live.py PROGRAM [--browser PATH] [--engine FILE] [--shots DIR] [--drags N] [--bits]

Of five studies (three laws of friction, formulas, a known function): every number of the result of the page equals that of the
program, bit for bit. Of one: sliders by keyboard and by pointer, fixing, undo, a link that restores, "copy as study.toml" that runs in
the program, a damaged link, no request beyond the page, no message on the console, and what the page shows without scripts. Of one
with several outputs, and of one with series: that one of them is shown. Of one with factors of all kinds: ranges that are narrow, or have
no slider. Further: copies while the run doubles, the focus and the steps of undo, a phone, slow drawing, links that are nonsense, paper.
With `--engine` the pages have that engine (`engine.wasm.gz`) in the place of their own. Times are printed, not judged; `--drags`
moves a slider so many times and prints the memory of the page before and after; with `--bits` numbers are compared and nothing else.
Exit code 1 if anything is wrong.
"""

import argparse
import base64
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from playwright.sync_api import sync_playwright

STUDIES = ["coulomb-general", "hk-general", "lugre-general", "cantilever-formula", "ishigami"]
SAMPLES = 1024
LARGEST_PAGE = 2_000_000
ROOT = Path(__file__).resolve().parents[2]

found = []


def expect(holds, what):
    if not holds:
        found.append(what)
        print(f"WRONG {what}", flush=True)


def run(program, *arguments):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True)
    if done.returncode != 0:
        raise SystemExit(f"apportion {' '.join(map(str, arguments))}: {done.stderr}")
    return done


def native(program, study, folder, *more):
    """The result of the program as JSON."""
    run(program, "run", study, "--charts", "none", "--no-journal", "--out", folder, *more)
    [result] = [path for path in folder.glob("*.json")]
    return json.loads(result.read_text())


def numbers(result):
    """What is estimated: all of a result but where, when and on what it was made."""
    return {key: result[key] for key in ("factors", "outputs", "validity", "effort") if key in result}


def differences(a, b, path=""):
    """Where two documents differ; numbers as they are written, which is to the last bit."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in sorted(a.keys() | b.keys()):
            yield from differences(a.get(key), b.get(key), f"{path}.{key}")
    elif isinstance(a, list) and isinstance(b, list) and len(a) == len(b):
        for place, pair in enumerate(zip(a, b)):
            yield from differences(*pair, f"{path}[{place}]")
    elif repr(a) != repr(b):
        yield f"{path}: {a!r} against {b!r}"


# The moment at which the page has a result of its own.
FIRST = """new MutationObserver((_, observer) => {
  if (!(document.body && document.body.dataset.samples > 0)) return;
  performance.mark("computed");
  observer.disconnect();
}).observe(document, { subtree: true, attributes: true, attributeFilter: ["data-samples"] });"""
# What the page shows in the moment after a button.
PRESSED = """(button) => {
  document.getElementById(button).click();
  const fields = Array.from(document.querySelectorAll("#factors input[type=number]"));
  return [document.body.dataset.samples, ...fields.map((field) => field.value)].join(" ");
}"""
TIMES = """() => ["first-contentful-paint", "computed"].map((name) => performance.getEntriesByName(name)[0].startTime)"""


class Browser:
    def __init__(self, playwright, path):
        flags = ["--no-sandbox", "--disable-background-networking", "--disable-component-update", "--enable-precise-memory-info", "--js-flags=--expose-gc"]
        self.browser = playwright.chromium.launch(executable_path=path, args=flags)

    def open(self, page_file, size=(1280, 900), scripts=True, fragment="", dark=False, unfolded=True):
        context = self.browser.new_context(
            viewport={"width": size[0], "height": size[1]}, java_script_enabled=scripts, color_scheme="dark" if dark else "light"
        )
        if scripts:
            context.add_init_script(FIRST)
        page = context.new_page()
        page.on("console", lambda message: expect(False, f"console: {message.text}"))
        page.on("pageerror", lambda error: expect(False, f"script: {error}"))
        own = ("file:", "blob:", "data:")
        page.on("request", lambda request: expect(request.url.startswith(own), f"request to {request.url}"))
        page.goto(page_file.as_uri() + fragment)
        if scripts and unfolded:
            page.evaluate("document.getElementById('more').open = true")
        return page


def settled(page, samples=65536):
    page.wait_for_function(f"document.body.dataset.samples === '{samples}'", timeout=120_000)


def ask(page, request):
    answer = page.evaluate("(request) => window.apportion.ask(request)", request)
    expect("done" in answer, f"refused: {answer}")
    return answer.get("done")


def state(page):
    return page.evaluate("Array.from(document.querySelectorAll('#factors input[type=number]')).map((field) => field.value).join(' ')")


def same_bits(arguments, browser, pages, folder):
    for name in STUDIES:
        study = ROOT / "studies" / f"{name}.toml"
        expected = native(arguments.program, study, folder / name, "--base-samples", SAMPLES)
        page = browser.open(pages[name])
        page.wait_for_function("window.apportion !== undefined")
        given = json.loads(page.locator("#study").text_content())["presets"][0]["text"]
        files = ask(page, {"wanted": "files", "text": given, "changes": [f"design.base_samples={SAMPLES}"]})
        got = json.loads(files["study.json"]) if "study.json" in files else json.loads(next(text for key, text in files.items() if key.endswith(".json")))
        wrong = list(differences(numbers(expected), numbers(got)))
        expect(not wrong, f"{name}: {len(wrong)} numbers differ, such as {wrong[:3]}")
        print(f"{name}: the same bits" if not wrong else f"{name}: other bits", flush=True)
        page.context.close()


def behaviour(arguments, browser, page_file, folder):
    begin = time.perf_counter()
    page = browser.open(page_file)
    expect(page.locator("#lead").inner_text() and page.locator("#indices").is_visible(), "no result of the program to begin with")
    settled(page)
    painted, computed = page.evaluate(TIMES)
    print(f"the program's result after {painted:.0f} ms, the page's own after {computed:.0f} ms, settled after {time.perf_counter() - begin:.2f} s: {page.locator('#state').text_content()}")
    before, lead = state(page), page.locator("#lead").inner_text()

    figures = page.locator("main figcaption b").all_inner_texts()
    expect(figures == [f"Figure {number}." for number in range(1, len(figures) + 1)] and len(figures) > 1, f"figures are numbered {figures}")

    sliders(page)
    log_uniform_from_nothing(page)
    # At once, whatever the engine is at: no number of before is taken for one of the study.
    expect(page.evaluate(PRESSED, "reset") == f"0 {before}", "reset waits for the engine")
    settled(page)
    page.evaluate("location.hash = '#content'")
    page.wait_for_function("location.hash === ''")
    expect(page.evaluate("document.body.dataset.samples") == "65536", "a jump within the page computes anew")

    handle = page.locator("fieldset[data-factor=thickness] input[data-key=largest]")
    handle.focus()
    for _ in range(200):
        page.keyboard.press("ArrowLeft")
    settled(page)
    by_keys = state(page)
    expect(by_keys != before, "the keyboard moves no slider")
    expect(page.locator("#lead").inner_text() != lead, "the lead does not follow")
    expect("#s=" in page.url, "the link does not hold the settings")

    # What a bar says is there at once; an entry of the legend puts its series away and back.
    bar = page.locator("#indices .wide .bars rect").first
    bar.hover()
    expect(page.locator(".tip").is_visible() and page.locator(".tip").inner_text().strip(), "no word about a bar")
    for hidden in (True, False):
        page.locator("#indices .wide .legend text").first.click()
        expect((bar.evaluate("bar => getComputedStyle(bar).visibility") == "hidden") == hidden, "the legend switches nothing")
    box = page.locator("fieldset[data-factor=length] input[data-key=smallest]").bounding_box()
    share = page.evaluate("(() => { const i = document.querySelector('fieldset[data-factor=length] input[data-key=smallest]'); return i.value / 1000; })()")
    x, y = box["x"] + 11 + share * (box["width"] - 22), box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + 60, y, steps=8)
    page.mouse.up()
    settled(page)
    by_pointer = state(page)
    expect(by_pointer != by_keys, "the pointer moves no slider")

    page.locator("fieldset[data-factor=width] input[data-key=fix]").check()
    settled(page)
    expect("width" not in page.locator("#indices tbody th").all_inner_texts(), "a fixed factor is still there")
    page.locator("#settings select[aria-label=friction]").select_option("hk")
    settled(page)
    for title in (page.locator("h1").inner_text(), page.title()):
        expect("Hurtado-Kim friction" in title and "Coulomb" not in title, f"the title of another law: {title}")
    link = page.url
    shown = state(page)

    other = browser.open(page_file, fragment=link[link.index("#"):])
    settled(other)
    expect(state(other) == shown, "the link does not restore")
    expect(other.locator("#lead").inner_text() == page.locator("#lead").inner_text(), "the link gives another result")
    other.context.close()

    text = asked_text(page)
    copied = folder / "copied.toml"
    copied.write_text(text)
    expected = native(arguments.program, copied, folder / "copied")
    files = ask(page, {"wanted": "files", "text": text, "changes": []})
    wrong = list(differences(numbers(expected), numbers(json.loads(files["study.json"]))))
    expect(not wrong, f"copied study: {len(wrong)} numbers differ, such as {wrong[:3]}")
    expect(expected["provenance"]["base_samples"] == 65536, "the copied study has other base samples")
    for button, ending in (("json", ".json"), ("csv", ".csv"), ("svg", "-indices.svg")):
        with page.expect_download() as download:
            page.locator(f"#{button}").click()
        saved = Path(download.value.path()).read_bytes()
        expect(download.value.suggested_filename == f"coulomb-general{ending}" and len(saved) > 500, f"{button} gives {download.value.suggested_filename}")

    for _ in range(2):
        page.locator("#undo").click()
    settled(page)
    expect(state(page) == by_pointer, "undo does not go back")
    page.locator("#redo").click()
    page.locator("#reset").click()
    settled(page)
    expect(state(page) == before and "#s=" not in page.url, "reset does not give the study of the file")

    # What cannot be is refused in words, and the page goes on.
    field = page.locator("fieldset[data-factor=thickness] input[data-parameter=min]")
    field.fill("99")
    field.press("Tab")
    page.wait_for_selector("#refused:not([hidden])")
    for words in (page.locator("#refused"), page.locator("fieldset[data-factor=thickness] .wrong")):
        expect(words.is_visible(), "a refusal that is hidden")
        said = words.inner_text()
        expect("min must be below max" in said and not any(word in said for word in ("--set", "study.toml", "^^")), f"refused: {said}")
    expect(page.locator(".wrong:visible").count() == 1, "a refusal at several factors")
    in_sight = page.evaluate("(() => { const box = document.getElementById('refused').getBoundingClientRect(); return box.top >= 0 && box.bottom <= innerHeight; })()")
    expect(in_sight and "from before" in page.locator("#refused").inner_text(), "old numbers are not said to be old")
    expect(float(page.evaluate("getComputedStyle(document.getElementById('indices')).opacity")) < 1, "old numbers look like new ones")
    page.locator("#undo").click()
    settled(page)
    expect(page.locator("#refused").is_hidden() and page.locator(".wrong:visible").count() == 0, "a refusal that stays")

    silent = browser.open(page_file, scripts=False)
    expect(silent.locator("#lead").inner_text().strip() and silent.locator("#indices svg").count() > 0, "nothing without scripts")
    expect(silent.locator("noscript").count() == 1, "no word about scripts")
    silent.context.close()
    return page


def several_outputs(arguments, browser, folder):
    """Of several outputs one is shown: the first one, or that of the menu."""
    page_file = folder / "several.html"
    run(arguments.program, "live", ROOT / "studies" / "soft-cantilever.toml", "--base-samples", SAMPLES, "--out", page_file)
    page = browser.open(page_file)
    for chosen in (None, "critical_time", "critical_force"):
        if chosen:
            page.locator("#settings select").nth(1).select_option(chosen)
        settled(page)
        words = (chosen or "critical_force").replace("_", " ")
        lead = page.locator("#lead").inner_text()
        expect(lead.startswith(f"For {words}, ") and lead.count("matters most") == 1, f"{chosen}: the page begins with {lead[:80]!r}")
        expect(page.locator("main figcaption").count() > 1, f"{chosen}: {page.locator('main figcaption').count()} figures")
    page.context.close()


def series(arguments, browser, folder):
    """A series is one output, with its charts and the bars beside its factors."""
    page_file = folder / "series.html"
    run(arguments.program, "live", ROOT / "studies" / "push-history.toml", "--base-samples", SAMPLES, "--out", page_file)
    page = browser.open(page_file)
    page.wait_for_function("document.body.dataset.samples >= 1024", timeout=120_000)
    for chosen in ("position_history", "critical_force", "force_history"):
        page.locator("#settings select[aria-label=output]").select_option(chosen)
        page.wait_for_function("document.body.dataset.samples >= 512", timeout=120_000)
        words = chosen.replace("_", " ")
        is_series = chosen != "critical_force"
        expect(words in page.locator("#lead").inner_text(), f"{chosen}: the page begins with {page.locator('#lead').inner_text()[:80]!r}")
        expect((page.locator("#series-1").count() == 1) == is_series, f"{chosen}: sections of a series")
        expect((page.locator("#indices").count() == 0) == is_series, f"{chosen}: sections of a single output")
        expect(page.locator("main figcaption").count() >= 2, f"{chosen}: {page.locator('main figcaption').count()} figures")
        expect(page.locator("fieldset.factor .meter:visible").count() == 4, f"{chosen}: no bars beside the factors")
    page.context.close()


def sliders(page, names=None):
    """Every slider moves by keyboard, and its field with it."""
    for name in names or page.eval_on_selector_all("fieldset.factor", "all => all.map((box) => box.dataset.factor)"):
        box = page.locator(f"fieldset[data-factor={name}]")
        for key, end, arrow in (("smallest", "min", "ArrowRight"), ("largest", "max", "ArrowLeft")):
            field = box.locator(f"input[data-parameter={end}], input[data-parameter$=mean]")
            before = field.input_value()
            box.locator(f"input[data-key={key}]").focus()
            for _ in range(10):
                page.keyboard.press(arrow)
            after = field.input_value()
            expect((float(after) > float(before)) == (end == "min") and after != before, f"the {key} of {name} stays at {before}")
    settled(page)


def log_uniform_from_nothing(page):
    """A log-uniform factor that began at 0 begins above it."""
    page.locator("#reset").click()
    box = page.locator("fieldset[data-factor=adhesion]")
    box.locator("select[data-key=kind]").select_option("log-uniform")
    settled(page)
    expect(float(box.locator("input[data-parameter=min]").input_value()) > 0, "log-uniform from 0")
    expect(page.locator("#refused").is_hidden(), "a log-uniform distribution is refused")


# A narrow range around a large value, and kinds of factors that others have not.
KINDS = """title = "Factors of all kinds"
model = "expression"

[outputs]
y = "narrow + spread + strength + ln(wide) + level + wait"

[design]
base_samples = 256

[factors]
narrow = { min = 1000.0, max = 1000.4, nominal = 1000.123456789 }
spread = { distribution = "normal", mean = 5000, sd = 0.03 }
strength = { distribution = "log-normal", p05 = 1.5, p95 = 3 }
wide = { distribution = "log-normal", log_mean = 0, log_sd = 4 }
level = { distribution = "discrete", values = [1, 2, 3, 5, 8, 13, 21, 34, 55, 89] }
wait = { distribution = "empirical", values = [0.1, 0.23, 0.31, 0.4] }
"""


def kinds(arguments, browser, folder):
    """Digits follow the width of a range, and are exact where nothing was typed."""
    study = folder / "kinds.toml"
    study.write_text(KINDS)
    run(arguments.program, "live", study, "--out", folder / "kinds.html")
    page = browser.open(folder / "kinds.html")
    settled(page)
    box = page.locator("fieldset[data-factor=narrow]")
    number = lambda name: float(box.locator(f"input[data-parameter={name}]").input_value())
    box.locator("input[data-key=largest]").focus()
    page.keyboard.press("ArrowLeft")
    expect(number("min") == 1000 and 1000.39 < number("max") < 1000.4, f"a narrow range moves to {number('min')} to {number('max')}")
    for kind, low, high in (("normal", "mean", "sd"), ("triangular", "min", "max"), ("uniform", "min", "max")):
        box.locator("select[data-key=kind]").select_option(kind)
        settled(page)
        least = (number(low), number(high))
        expect(1000 <= least[0] < 1000.3 and least[1] > 0.05, f"a narrow range is {kind} of {least}")
        expect(page.locator("#refused").is_hidden(), f"a narrow range is refused as {kind}")
    box.locator("input[data-key=fix]").check()
    settled(page)
    fixed = asked_text(page)
    expect("1000.123456789" in fixed, "a factor is not fixed at its nominal value")
    page.locator("#reset").click()
    sliders(page, ["narrow", "spread", "strength", "wide"])
    page.locator("#reset").click()
    settled(page)
    for name, words in (("level", "values 1; 2; 3; 5; 8; 13; 21; 34; … (10 in all)"), ("wait", "values 0.1; 0.23; 0.31; 0.4")):
        expect(words in page.locator(f"fieldset[data-factor={name}]").inner_text(), f"the values of {name} are not shown")
    for field in page.locator("#factors input[type=number]").all():
        expect(len(field.input_value()) <= 10, f"a field has all of {field.input_value()}")
        expect(field.evaluate("field => field.scrollWidth <= field.clientWidth + 1"), f"a field cuts {field.input_value()} off")
    expect("log_mean = 0.7520386983881372" not in asked_text(page), "a study that was not changed is another one")
    field = page.locator("fieldset[data-factor=strength] input[data-parameter=log_sd]")
    field.fill("0.25")
    field.press("Tab")
    settled(page)
    expect("log_mean = 0.7520386983881372, log_sd = 0.25" in asked_text(page), "a field that was not edited loses digits")
    page.context.close()


FOCUS = """() => {
  const active = document.activeElement, box = active.closest("fieldset.factor");
  return `${box ? box.dataset.factor : ""} ${active.dataset.key || active.id || active.tagName}`;
}"""


def keyboard(arguments, browser, page_file, folder):
    """Quick moves of one handle are one step, and undo leaves the focus where it was."""
    page = browser.open(page_file)
    settled(page)
    before = state(page)
    for name in ("thickness", "length"):
        page.locator(f"fieldset[data-factor={name}] input[data-key=smallest]").focus()
        for _ in range(10):
            page.keyboard.press("ArrowRight")
        if name == "thickness":
            between = state(page)
    for expected in (between, before):
        page.keyboard.press("Control+z")
        settled(page)
        expect(state(page) == expected, "ten moves of a handle are not one step of undo")
        expect(page.evaluate(FOCUS) == "length smallest", f"undo moves the focus to {page.evaluate(FOCUS)}")
    page.keyboard.press("Control+y")
    settled(page)
    page.locator("#undo").focus()
    page.keyboard.press("Enter")
    settled(page)
    expect(page.evaluate(FOCUS) == " redo", f"the last undo moves the focus to {page.evaluate(FOCUS)}")
    fix = page.locator("fieldset[data-factor=width] input[data-key=fix]")
    fix.focus()
    page.keyboard.press("Space")
    settled(page)
    expect(page.evaluate(FOCUS) == "width fix", f"fixing moves the focus to {page.evaluate(FOCUS)}")
    page.context.close()


def phone(arguments, browser, page_file, folder):
    """The first screen has all sliders and the figure, on a phone too, where boxes are as large as fingers."""
    for size in ((1280, 800), (390, 844)):
        page = browser.open(page_file, size=size, unfolded=False)
        settled(page)
        svg = page.locator("#indices figure svg:visible").first
        for part in [svg, *page.locator("fieldset.factor .slider").all()]:
            box = part.bounding_box()
            expect(box["y"] >= 0 and box["y"] + box["height"] <= size[1], f"beyond the first screen of {size}: {box}")
        page.context.close()
    page = browser.open(page_file, size=(390, 844))
    settled(page)
    box = page.locator("fieldset[data-factor=length] .kinds input").bounding_box()
    expect(min(box["width"], box["height"]) >= 24, f"a box to tick of {box}")
    page.context.close()


def slow_drawing(arguments, browser, page_file, folder):
    """Where drawing takes long, a handle that moves has few base points."""
    page = browser.open(page_file)
    settled(page)
    samples = page.evaluate("""async () => {
      const height = Object.getOwnPropertyDescriptor(HTMLElement.prototype, "offsetHeight");
      Object.defineProperty(document.body, "offsetHeight", { get() {
        const begin = performance.now();
        while (performance.now() - begin < 30);
        return height.get.call(this);
      } });
      const input = document.querySelector("fieldset[data-factor=thickness] input[data-key=largest]");
      for (let i = 0; i < 30; i++) {
        input.value = 500 + 10 * i;
        input.dispatchEvent(new Event("input", { bubbles: true }));
        await new Promise((resolve) => setTimeout(resolve, 60));
      }
      return document.body.dataset.samples;
    }""")
    expect(int(samples) <= 512, f"{samples} base points while drawing is slow")
    page.context.close()


def settings_link(**changed):
    text = json.dumps({"preset": 0, "factors": {}, "choices": {}, "output": None} | changed)
    return "#s=" + base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def links(arguments, browser, page_file, folder):
    """Links are followed, back and forth; those that say nothing sensible leave the study as it was."""
    page = browser.open(page_file)
    settled(page)
    before = state(page)
    narrow = settings_link(factors={"thickness": {"distribution": {"name": "uniform", "min": 1, "max": 1.5}}}, choices={"friction": "hk", "adhesion_in_load": "true"})
    page.evaluate("link => { location.hash = link; }", narrow)
    page.wait_for_function("document.title.includes('Hurtado-Kim')")
    settled(page)
    linked = state(page)
    expect(linked != before, "a link in the address bar is not followed")
    page.locator("#undo").click()
    settled(page)
    expect(state(page) == before, "a link in the address bar cannot be undone")
    page.locator("#redo").click()
    settled(page)
    expect(state(page) == linked, "a link in the address bar cannot be redone")
    page.evaluate("location.hash = '#content'")
    page.wait_for_function("location.hash.startsWith('#s=')")
    expect(state(page) == linked, "a jump within the page changes settings")
    page.go_back()
    page.go_back()
    page.wait_for_function("!document.title.includes('Hurtado-Kim')")
    settled(page)
    expect(state(page) == before and "#s=" not in page.url, "Back does not give the study of the file")
    page.context.close()
    uniform = {"name": "uniform", "min": 1, "max": 1.5}
    nonsense = [
        {"factors": None}, {"factors": []}, {"factors": {"thickness": {}}}, {"factors": {"thickness": {"fixed": "1"}}}, {"preset": "length"},
        {"factors": {"nobody": {"distribution": uniform}}}, {"factors": {"thickness": {"distribution": uniform | {"min": None}}}},
        {"preset": 99}, {"choices": {"friction": "none"}}, {"choices": {"colour": "red"}}, {"output": "nothing"}, {"output": {}},
    ]
    for fragment in ["#s=%%%damaged", "#s=bnVsbA"] + [settings_link(**changed) for changed in nonsense]:
        damaged = browser.open(page_file, fragment=fragment)
        damaged.wait_for_selector("#refused:not([hidden])")
        expect("damaged" in damaged.locator("#refused").inner_text(), f"no word about a damaged link: {fragment}")
        expect(state(damaged) == before and "#s=" not in damaged.url, f"a damaged link changes the study: {fragment}")
        damaged.context.close()


def paper(arguments, browser, page_file, folder):
    """On paper, and without scripts, a table says which ranges were used."""
    silent = browser.open(page_file, scripts=False)
    table = silent.locator("#ranges")
    expect(table.is_visible() and "min 0.25, max 2.5 (µm)" in table.inner_text(), "no ranges without scripts")
    silent.context.close()
    page = browser.open(page_file)
    settled(page)
    expect(page.locator("#ranges").is_hidden(), "the table for paper is on the screen")
    page.locator("fieldset[data-factor=width] input[data-key=fix]").check()
    field = page.locator("fieldset[data-factor=thickness] input[data-parameter=min]")
    field.fill("0.5")
    field.press("Tab")
    settled(page)
    page.emulate_media(media="print")
    expect(page.locator("#controls").is_hidden(), "controls on paper")
    rows = page.locator("#ranges tr").all_inner_texts()
    for name, words in (("thickness", "uniform, min 0.5, max 2.5 (µm)\tchanged; in the study uniform, min 0.25, max 2.5 (µm)"), ("width", "fixed at ")):
        expect(any(row.startswith(name) and words in row for row in rows), f"on paper {name} is not said: {rows}")
    expect(sum("changed" in row for row in rows) == 2, f"on paper {rows}")
    page.context.close()


def copies(arguments, browser, page_file, folder):
    """A copy is of what is shown, and ends no doubling; there is none of a study that cannot be."""
    page = browser.open(page_file)
    page.wait_for_function("window.apportion !== undefined")
    # What is shown at the moment of the copy: the doubling goes on at once.
    page.evaluate("""new MutationObserver(() => { window.copied = document.body.dataset.samples; })
      .observe(document.getElementById("text"), { attributes: true, attributeFilter: ["open"] })""")
    field = page.locator("fieldset[data-factor=thickness] input[data-parameter=min]")
    for value, samples in (("0.5", None), ("0.6", 512), ("0.7", 2048)):
        field.fill(value)
        field.press("Tab")
        if samples:
            page.wait_for_function(f"document.body.dataset.samples >= {samples}")
        text = asked_text(page, still=True)
        points = page.evaluate("window.copied")
        expect(f"base_samples = {points}\n" in text and f"min = {value}" in text, f"the copy is not of {points} base points from {value}")
        page.locator("#text button").click()
        settled(page)
    field.fill("99")
    field.press("Tab")
    page.wait_for_selector("#refused:not([hidden])")
    page.on("download", lambda download: expect(False, f"{download.suggested_filename} of a study that cannot be"))
    for button in ("toml", "json", "csv", "svg"):
        page.locator(f"#{button}").click()
        page.wait_for_timeout(100)
        expect(page.locator("#text[open]").count() == 0, f"{button} of a study that cannot be")
        expect("min must be below max" in page.locator("#refused").inner_text(), f"{button}: no word about a study that cannot be")
    page.context.close()


def asked_text(page, still=False):
    """The study as it is copied; `still`: with its dialog open."""
    page.locator("#toml").click()
    page.wait_for_selector("#text[open]")
    text = page.locator("#text textarea").input_value()
    if not still:
        page.locator("#text button").click()
    return text


def drags(page, number):
    """Memory before and after, and the time from a move to new bars."""
    script = """async (number) => {
      const input = document.querySelector('fieldset[data-factor=thickness] input[data-key=largest]');
      const lead = document.getElementById('lead');
      const times = [];
      for (let i = 0; i < number; i++) {
        const seen = new Promise((resolve) => new MutationObserver((_, o) => { o.disconnect(); resolve(); }).observe(lead, { childList: true }));
        const begin = performance.now();
        input.value = 500 + (i * 37) % 300;
        input.dispatchEvent(new Event('input', { bubbles: true }));
        await Promise.race([seen, new Promise((resolve) => setTimeout(resolve, 1000))]);
        times.push(performance.now() - begin);
      }
      times.sort((a, b) => a - b);
      return [times[Math.floor(number / 2)], times[Math.floor(number * 0.95)], document.body.dataset.samples];
    }"""
    memory = "(() => { if (window.gc) gc(); return performance.memory.usedJSHeapSize; })()"
    page.evaluate(script, 20)
    before = page.evaluate(memory)
    median, slow, samples = page.evaluate(script, number)
    after = page.evaluate(memory)
    print(f"{number} moves of a slider: new bars after {median:.1f} ms (95 %: {slow:.1f} ms) with {samples} base points; heap {before / 1e6:.1f} -> {after / 1e6:.1f} MB")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--browser", default="chromium")
    parser.add_argument("--engine", type=Path)
    parser.add_argument("--shots", type=Path)
    parser.add_argument("--drags", type=int, default=0)
    parser.add_argument("--bits", action="store_true", help="compare the numbers alone")
    arguments = parser.parse_args()
    arguments.program = str(Path(arguments.program).resolve())
    with tempfile.TemporaryDirectory() as folder, sync_playwright() as playwright:
        folder = Path(folder)
        pages = {}
        for name in STUDIES:
            pages[name] = folder / f"{name}-live.html"
            run(arguments.program, "live", ROOT / "studies" / f"{name}.toml", "--base-samples", SAMPLES, "--out", pages[name])
            if arguments.engine:
                page = pages[name].read_text()
                begin = page.index('id="engine">') + len('id="engine">')
                end = page.index("</script>", begin)
                pages[name].write_text(page[:begin] + base64.b64encode(arguments.engine.read_bytes()).decode() + page[end:])
            else:
                size = pages[name].stat().st_size
                expect(size <= LARGEST_PAGE, f"{name}: the page has {size} bytes, more than {LARGEST_PAGE}")
        browser = Browser(playwright, arguments.browser)
        same_bits(arguments, browser, pages, folder)
        if not arguments.bits:
            page = behaviour(arguments, browser, pages["coulomb-general"], folder)
            several_outputs(arguments, browser, folder)
            series(arguments, browser, folder)
            kinds(arguments, browser, folder)
            keyboard(arguments, browser, pages["coulomb-general"], folder)
            phone(arguments, browser, pages["coulomb-general"], folder)
            slow_drawing(arguments, browser, pages["coulomb-general"], folder)
            links(arguments, browser, pages["coulomb-general"], folder)
            paper(arguments, browser, pages["coulomb-general"], folder)
            copies(arguments, browser, pages["coulomb-general"], folder)
            if arguments.drags:
                drags(page, arguments.drags)
        if arguments.shots:
            arguments.shots.mkdir(parents=True, exist_ok=True)
            for width, height in ((1280, 900), (390, 844)):
                for dark in (False, True):
                    shot = browser.open(pages["coulomb-general"], size=(width, height), dark=dark)
                    settled(shot)
                    name = f"live-{width}{'-dark' if dark else ''}.png"
                    shot.screenshot(path=arguments.shots / name, full_page=True)
    if found:
        sys.exit(f"{len(found)} findings")
    print("live pages: all well")


if __name__ == "__main__":
    main()
