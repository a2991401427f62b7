"use strict";
const at = (id) => document.getElementById(id);
const given = JSON.parse(at("study").textContent);
const FEWEST = 256;
const MAX_SAMPLES = 65536;
// A step of the doubling that would take longer is not made.
const LONGEST = 10;
const FRAME = 1 / 60;

const make = (tag, properties = {}, ...children) => {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(properties)) {
    if (name in element) element[name] = value;
    else element.setAttribute(name, value);
  }
  element.append(...children);
  return element;
};
// To a thousandth of the power of ten below `width`: of a number alone four digits, of a narrow range as many as it takes.
const rounded = (x, width = Math.abs(x)) => {
  if (!(width > 0)) return x;
  const power = Math.floor(Math.log10(width)) - 3;
  // By way of text: a product of binary fractions would have digits of its own.
  return Number(power > 0 ? `${Math.round(x / 10 ** power)}e${power}` : x.toFixed(Math.min(-power, 100)));
};
const words = (name) => name.replaceAll("_", " ");
const number = (x) => Math.abs(x) >= 1e9 || (x !== 0 && Math.abs(x) < 1e-3) ? x.toExponential() : String(x);
// Six digits of a number, and those that tell apart what is as narrow as `width`.
const brief = (x, width = Infinity) => number(rounded(x, Math.min(Math.abs(x), width) / 100));
const unitIn = (unit) => (unit === "1" ? "" : unit.replace(/\bu(?=[a-zA-Z])/g, "µ").replace(/([a-zA-Z])2\b/g, "$1²").replace(/([a-zA-Z])3\b/g, "$1³"));
const grouped = (x) => x.toLocaleString("en").replaceAll(",", "\u202f");

// --- The engine -------------------------------------------------------------------------------------------------------

let module = null;
let worker = null;
let calls = 0;
const waiting = new Map();

const listen = () => {
  worker.onmessage = ({ data }) => {
    const hear = waiting.get(data.id);
    waiting.delete(data.id);
    if (hear) hear(data);
  };
};
const begin = () => {
  worker = new Worker(engineSource);
  listen();
  worker.postMessage({ module });
};
const tell = (request) => new Promise((resolve) => {
  const id = ++calls;
  waiting.set(id, resolve);
  worker.postMessage({ id, request });
});
// A thread that computes hears nothing: it is ended, and another one begins with the compiled engine.
const cancel = () => {
  worker.terminate();
  const cancelled = Array.from(waiting.values());
  waiting.clear();
  begin();
  for (const hear of cancelled) hear({ cancelled: true });
};

// --- What is asked ----------------------------------------------------------------------------------------------------

// Of each factor that was changed its distribution, or the value at which it is fixed; and the choices of the model.
const unchanged = (preset = 0) => ({ preset, factors: {}, choices: {}, output: null });
let state = unchanged();
let past = [];
let future = [];
let description = null;

const toml = (value) => {
  if (typeof value === "string") return /^-?inf$/.test(value) ? value : JSON.stringify(value);
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  if (typeof value === "number" && Number.isInteger(value) && Math.abs(value) < 1e15) return `${value}.0`;
  return String(value);
};
const text = () => given.presets[state.preset].text;
const changes = (samples) => {
  const all = [];
  for (const factor of description ? description.factors : []) {
    const changed = state.factors[factor.name];
    if (!changed) continue;
    const unit = factor.unit === "1" ? "" : factor.unit;
    if (changed.fixed !== undefined) {
      const value = unit ? JSON.stringify(`${number(changed.fixed)} ${unit}`) : toml(changed.fixed);
      all.push(`factor.${factor.name}=${value}`);
      continue;
    }
    const { name, ...parameters } = changed.distribution;
    const keys = Object.entries({ distribution: name, ...parameters, ...(unit ? { unit } : {}), ...(factor.group ? { group: factor.group } : {}) });
    all.push(`factor.${factor.name}={ ${keys.map(([key, value]) => `${key} = ${toml(value)}`).join(", ")} }`);
  }
  for (const [name, value] of Object.entries(state.choices)) all.push(`${description.model}.${name}=${value}`);
  if (state.output && description && description.all_outputs.length) all.push(`outputs=[${JSON.stringify(state.output)}]`);
  // Here runs cost less than the polynomials that would spare some.
  if (samples) all.push(`design.base_samples=${samples}`, "analysis.surrogate=off");
  return all;
};
// The title of the study names a choice, such as the law of friction, as long as it is the one.
const NAMES = { coulomb: "Coulomb", hk: "Hurtado-Kim", lugre: "LuGre" };
const entitle = () => {
  let { title, heading } = given.presets[state.preset];
  for (const { name, value } of description ? description.choices : []) {
    const chosen = state.choices[name];
    if (chosen === undefined) continue;
    const titled = (choice) => `${NAMES[choice] || choice} ${words(name)}`;
    title = title.replace(titled(String(value)), titled(chosen));
    heading = heading.replace(titled(String(value)), titled(chosen));
  }
  document.title = title;
  document.querySelector("h1").innerHTML = heading;
};
const request = (wanted, samples, more = {}) => ({ wanted, text: text(), changes: changes(samples), ...more });

// --- What is shown ----------------------------------------------------------------------------------------------------

const QUICK = ["warnings", "indices", "shares", "series-1"];
const ALL = ["warnings", "indices", "shares", "series-1", "interactions", "distribution", "validity"];
// Of which settings the result is, and for which there is none.
let shown = { settings: null, samples: 0 };
let refused = { settings: null, problem: null };
let hearers = [];

// A word about the page itself, until something is changed.
let notice = null;
// An error is shown next to its factor, and above the numbers, which are from before the change.
const refuse = (problem, isOld = true) => {
  const [, factor, rest] = /^factor `([^`]+)`:? ([^]*)/.exec(problem || "") || [];
  const plain = (text) => text.replaceAll("`", "").replaceAll(">=", "≥").replaceAll("<=", "≤");
  let isAtFactor = false;
  for (const note of document.querySelectorAll(".factor .wrong")) {
    const isIts = note.closest("fieldset").dataset.factor === factor;
    note.hidden = !isIts;
    note.textContent = isIts ? plain(rest) : "";
    isAtFactor = isAtFactor || isIts;
  }
  const place = at("refused");
  place.hidden = !problem;
  document.body.classList.toggle("old", Boolean(problem) && isOld);
  const said = isAtFactor ? `${words(factor)}: ${plain(rest)}` : plain(problem || "");
  const sentence = /[.!?]$/.test(said) ? said : `${said}.`;
  place.textContent = problem && isOld ? `No new result: ${sentence} The numbers below are from before this change.` : said;
  refused = { settings: problem && isOld ? JSON.stringify(state) : null, problem };
  for (const hear of hearers.splice(0)) hear();
};
const show = (view, settings, seconds, whole) => {
  shown = { settings, samples: view.base_samples, lead: view.plain_lead };
  at("lead").innerHTML = view.lead.map((text) => `<p class="lead">${text}</p>`).join("");
  const main = at("content");
  const kept = new Set();
  for (const { id, title, html } of view.sections) {
    kept.add(id);
    let section = at(id);
    if (!section) {
      section = make("section", { id }, make("h2", { id: `${id}-heading` }), make("div", { className: "body" }));
      section.setAttribute("aria-labelledby", `${id}-heading`);
      const later = ALL.slice(ALL.indexOf(id) + 1).map(at).find(Boolean);
      main.insertBefore(section, later || null);
    }
    section.querySelector("h2").innerHTML = title;
    section.lastElementChild.innerHTML = html;
  }
  const old = whole ? ALL : QUICK;
  for (const id of old) if (!kept.has(id) && at(id)) at(id).remove();
  for (const box of document.querySelectorAll("fieldset.factor")) {
    const percentage = view.percentages[box.dataset.factor];
    const known = percentage && Number.isFinite(percentage.total);
    const meter = box.querySelector(".meter");
    meter.hidden = !known;
    if (!known) continue;
    meter.firstElementChild.style.width = `${Math.min(100, Math.max(0, percentage.total))}%`;
    const rounded = percentage.total < 10 ? percentage.total.toFixed(1) : Math.round(percentage.total);
    meter.lastElementChild.innerHTML = `<var>S</var><sub>T</sub> ${rounded}\u00a0%`;
  }
  at("state").textContent =
    `${grouped(view.runs)} runs of the model in ${seconds < 0.0095 ? (seconds * 1000).toFixed(1) : Math.round(seconds * 1000)} ms, here in this page; ` +
    `${grouped(view.base_samples)} base points.`;
  document.body.dataset.samples = view.base_samples;
};
// Sections that the program made have their body in pieces: here each has one element.
for (const section of document.querySelectorAll("main > section")) {
  const body = make("div", { className: "body" });
  body.append(...Array.from(section.childNodes).filter((node) => node !== section.querySelector("h2")));
  section.append(body);
}

// What is to be run next: once, as quickly as a handle moves, or to the end, doubling. One run at a time: of all the moves of a
// handle while it goes on only the last one counts.
let goal = null;
let flying = 0;
let quick = FEWEST;
// The copy that is being made.
let asking = null;
// How many seconds it took, and how many drawing took; nothing if it was cancelled.
const run = async (samples, whole) => {
  const settings = JSON.stringify(state);
  flying = samples;
  const answer = await tell(request("run", samples, { sections: whole ? ALL : QUICK, output: state.output }));
  flying = 0;
  if (answer.cancelled) return null;
  if (answer.broken) {
    cancel();
    refuse(`The engine stopped: ${answer.broken}`);
    return {};
  }
  if (notice && answer.answer.refused === undefined) refuse(notice, false);
  else refuse(answer.answer.refused);
  if (answer.answer.done === undefined) return {};
  const begin = performance.now();
  show(answer.answer.done, settings, answer.seconds, whole);
  // The browser lays the page out when it is asked for a height.
  void document.body.offsetHeight;
  return { seconds: answer.seconds, drawing: (performance.now() - begin) / 1000 };
};
let pumping = false;
const pump = async () => {
  if (pumping) return;
  pumping = true;
  for (;;) {
    while (asking) await asking;
    const mine = goal;
    if (!mine) break;
    if (mine.samples) {
      // The first step shows at once what is drawn quickly; all else comes with the next one, of the same size if none is larger.
      const isFirst = mine.samples === FEWEST && !mine.whole;
      const done = await run(mine.samples, !isFirst);
      if (goal !== mine || !done) continue;
      const { seconds } = done;
      if (seconds && 2 * mine.samples <= MAX_SAMPLES && 2.2 * seconds <= LONGEST) {
        mine.samples *= 2;
      } else if (seconds && isFirst) {
        mine.whole = true;
      } else {
        goal = null;
        // A reader of the screen hears the sentence once it has settled.
        if (seconds) at("announcement").textContent = shown.lead.join(" ");
      }
    } else {
      goal = null;
      const { seconds, drawing } = await run(quick, false) || {};
      if (seconds + drawing < FRAME / 2 && quick < MAX_SAMPLES / 4) quick *= 2;
      if (seconds + drawing > FRAME && quick > FEWEST) quick /= 2;
    }
  }
  pumping = false;
};
const interrupt = () => {
  if (flying > 2 * quick) cancel();
};
const drag = () => {
  document.body.dataset.samples = "0";
  goal = {};
  interrupt();
  pump();
};
const settle = () => {
  document.body.dataset.samples = "0";
  goal = { samples: FEWEST };
  interrupt();
  pump();
};

