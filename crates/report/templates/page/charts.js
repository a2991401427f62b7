(() => {
"use strict";
// What a mark says is shown at once, under the pointer or the finger; its title would come late, or never.
const tip = document.createElement("div");
tip.className = "tip";
tip.hidden = true;
tip.setAttribute("aria-hidden", "true");
document.body.append(tip);
const labelOf = (target) => {
  for (let mark = target; mark instanceof SVGElement && !(mark instanceof SVGSVGElement); mark = mark.parentElement) {
    const title = mark.querySelector(":scope > title");
    if (title) {
      mark.dataset.tip = title.textContent;
      mark.setAttribute("aria-label", title.textContent);
      title.remove();
    }
    if (mark.dataset.tip) return mark.dataset.tip;
  }
  return "";
};
// S_1 and S_T as they are set everywhere else on the page.
const index = (below) => {
  const all = document.createElement("span");
  all.append(...["var", "sub"].map((name) => document.createElement(name)));
  [all.firstChild.textContent, all.lastChild.textContent] = ["S", below];
  return all;
};
const show = (event) => {
  const text = labelOf(event.target);
  tip.hidden = !text;
  if (!text) return;
  tip.replaceChildren(...text.split(/\b(S_[1T])\b/).map((part, i) => (i % 2 ? index(part[2]) : part)));
  const { width, height } = tip.getBoundingClientRect();
  const left = Math.max(4, Math.min(event.clientX - width / 2, innerWidth - width - 4));
  const above = event.clientY - height - 12;
  tip.style.left = `${left}px`;
  tip.style.top = `${above > 4 ? above : event.clientY + 18}px`;
};
const hide = () => { tip.hidden = true; };
addEventListener("pointermove", show, { passive: true });
addEventListener("pointerdown", show, { passive: true });
addEventListener("scroll", hide, { passive: true, capture: true });
addEventListener("keydown", (event) => { if (event.key === "Escape") hide(); });
document.addEventListener("pointerleave", hide);

// An entry of a legend lifts its series out of the others; a click puts the series away or back.
const colour = (mark) => [mark.getAttribute("fill"), mark.getAttribute("stroke")].find((ink) => ink && ink !== "none");
const entry = (target) => {
  if (!(target instanceof SVGElement) || !target.closest(".legend")) return null;
  const text = target.closest("text");
  const swatch = text ? text.previousElementSibling : target;
  const words = text || target.nextElementSibling;
  const legend = target.closest(".legend");
  if (!swatch || !words || words.tagName !== "text") return null;
  // What has the colour of all text, such as an interval, is no series.
  const svg = target.ownerSVGElement;
  const ink = colour(swatch);
  return ink && ink !== svg.getAttribute("fill") ? { svg, legend, ink, words } : null;
};
const marks = (svg) => Array.from(svg.querySelectorAll("[fill], [stroke]")).filter((mark) => !mark.closest(".legend") && mark.tagName !== "g" && mark.tagName !== "text");
const inks = (legend) => new Set(Array.from(legend.children).filter((child) => child.tagName !== "text").map(colour));
let lifted = null;
const lower = () => {
  if (!lifted) return;
  for (const mark of marks(lifted)) mark.style.opacity = "";
  lifted = null;
};
addEventListener("pointerover", (event) => {
  const found = entry(event.target);
  lower();
  if (!found) return;
  lifted = found.svg;
  const all = inks(found.legend);
  for (const mark of marks(found.svg)) if (all.has(colour(mark)) && colour(mark) !== found.ink) mark.style.opacity = 0.15;
});
addEventListener("click", (event) => {
  const found = entry(event.target);
  if (!found) return;
  const away = !found.words.classList.contains("away");
  found.words.classList.toggle("away", away);
  for (const mark of marks(found.svg)) if (colour(mark) === found.ink) mark.style.visibility = away ? "hidden" : "";
});
})();
