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
