(() => {
"use strict";
const all = (selector) => Array.from(document.querySelectorAll(selector));

// On a phone the contents are folded until asked for.
const contents = document.querySelector("#contents details");
if (contents && matchMedia("(max-width: 620px)").matches) contents.open = false;

// What does not scroll needs no stop of the keyboard.
const stops = () => {
  for (const box of all(".table, pre")) {
    if (box.scrollWidth > box.clientWidth + 1) box.setAttribute("tabindex", "0");
    else box.removeAttribute("tabindex");
  }
};
stops();
addEventListener("resize", stops);
addEventListener("toggle", stops, true);

// The heading of a column sorts by it: once as it was, once the other way round, then as at first.
const value = (row, place) => {
  const text = row.cells[place] ? row.cells[place].innerText.trim().replace(/\u2212/g, "-").replace(/[\u202f\u00a0]/g, "") : "";
  const number = /^[<>[(]?\s*(-?\d+(?:\.\d+)?(?:e-?\d+)?)/.exec(text);
  return number ? Number(number[1]) : text;
};
const compare = (a, b) => {
  if (typeof a === typeof b) return typeof a === "number" ? a - b : a.localeCompare(b);
  return typeof a === "number" ? -1 : 1;
};
for (const table of all("main table")) {
  const body = table.tBodies[0];
  const rows = body ? Array.from(body.rows) : [];
  const moving = rows.filter((row) => !row.classList.contains("sum"));
  if (!table.tHead || moving.length < 3) continue;
  Array.from(table.tHead.rows[0].cells).forEach((heading, place) => {
    if (!heading.textContent.trim()) return;
    const button = document.createElement("button");
    button.type = "button";
    button.title = "Sort by this column";
    button.append(...heading.childNodes);
    heading.append(button);
    // Numbers from the largest on, words from A on.
    const first = heading.classList.contains("number") ? -1 : 1;
    button.addEventListener("click", () => {
      const sorted = heading.getAttribute("aria-sort");
      const names = { "1": "ascending", "-1": "descending" };
      const turn = !sorted ? first : sorted === names[first] ? -first : 0;
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      if (turn) heading.setAttribute("aria-sort", names[turn]);
      const order = turn ? [...moving].sort((a, b) => turn * compare(value(a, place), value(b, place))) : moving;
      body.append(...order, ...rows.filter((row) => row.classList.contains("sum")));
    });
  });
}

// The section that is being read is marked in the contents.
const links = new Map(all("#contents a").map((link) => [link.getAttribute("href").slice(1), link]));
const sections = all("main > section");
const mark = () => {
  if (!links.size) return;
  const read = sections.filter((section) => section.getBoundingClientRect().top < innerHeight / 3).pop();
  for (const [id, link] of links) {
    if (read && read.id === id) link.setAttribute("aria-current", "true");
    else link.removeAttribute("aria-current");
  }
};
addEventListener("scroll", mark, { passive: true });
mark();

// A frame is as high as what it shows.
for (const frame of all(".frame iframe")) {
  const fit = () => {
    const inside = frame.contentDocument;
    if (!inside || !inside.body) return;
    const height = Math.ceil(inside.body.getBoundingClientRect().height);
    if (height > 0) frame.style.height = `${height + 2}px`;
  };
  const watch = () => {
    fit();
    if (frame.contentDocument && frame.contentDocument.body) new ResizeObserver(fit).observe(frame.contentDocument.body);
  };
  frame.addEventListener("load", watch);
  // What is folded has no height yet.
  addEventListener("toggle", fit, true);
  if (frame.contentDocument && frame.contentDocument.readyState === "complete") watch();
}

// On paper nothing is folded.
let folded = [];
addEventListener("beforeprint", () => {
  folded = all("details:not([open])");
  for (const details of folded) details.open = true;
});
addEventListener("afterprint", () => {
  for (const details of folded) details.open = false;
  folded = [];
});
})();
