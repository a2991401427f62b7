(() => {
"use strict";
const at = (id) => document.getElementById(id);
const given = JSON.parse(at("study").textContent);
const FEWEST = 256;
const MOST = 65536;
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
// Numbers as people type them: four digits, no trailing zeros.
const rounded = (x) => Number(x.toPrecision(4));
const words = (name) => name.replaceAll("_", " ");
const number = (x) => Math.abs(x) >= 1e9 || (x !== 0 && Math.abs(x) < 1e-3) ? x.toExponential() : String(x);
const inWords = (unit) => (unit === "1" ? "" : unit.replace(/\bu(?=[a-zA-Z])/g, "µ").replace(/([a-zA-Z])2\b/g, "$1²").replace(/([a-zA-Z])3\b/g, "$1³"));
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
let state = { preset: 0, factors: {}, choices: {}, output: null };
let past = [];
let future = [];
let description = null;

const toml = (value) => {
  if (typeof value === "string") return JSON.stringify(value);
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

const QUICK = ["mind", "indices", "shares", "series-1"];
const ALL = ["mind", "indices", "shares", "series-1", "interactions", "distribution", "validity"];
let shown = { samples: 0 };

// A word about the page itself, until something is changed.
let notice = null;
// What is wrong stands beside the factor that it is about, and above the numbers, which are those of before.
const refuse = (problem, isOld = true) => {
  const [, factor, rest] = /^factor `([^`]+)`:? ([^]*)/.exec(problem || "") || [];
  const plain = (text) => text.replaceAll("`", "").replaceAll(">=", "≥").replaceAll("<=", "≤");
  let beside = false;
  for (const note of document.querySelectorAll(".factor .wrong")) {
    const isIts = note.closest("fieldset").dataset.factor === factor;
    note.hidden = !isIts;
    note.textContent = isIts ? plain(rest) : "";
    beside = beside || isIts;
  }
  const place = at("refused");
  place.hidden = !problem;
  document.body.classList.toggle("old", Boolean(problem) && isOld);
  const said = beside ? `${words(factor)}: ${plain(rest)}` : plain(problem || "");
  const sentence = /[.!?]$/.test(said) ? said : `${said}.`;
  place.textContent = problem && isOld ? `No new result: ${sentence} The numbers below are old: those before this change.` : said;
};
const show = (view, seconds, whole) => {
  shown = { samples: view.base_samples, lead: view.plain_lead };
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
const run = async (samples, whole) => {
  flying = samples;
  const answer = await tell(request("run", samples, { sections: whole ? ALL : QUICK, output: state.output }));
  flying = 0;
  if (answer.cancelled) return 0;
  if (answer.broken) {
    cancel();
    refuse(`The engine stopped: ${answer.broken}`);
    return 0;
  }
  if (notice && answer.answer.refused === undefined) refuse(notice, false);
  else refuse(answer.answer.refused);
  if (answer.answer.done === undefined) return 0;
  show(answer.answer.done, answer.seconds, whole);
  return answer.seconds;
};
let pumping = false;
const pump = async () => {
  if (pumping) return;
  pumping = true;
  while (goal) {
    const mine = goal;
    if (mine.samples) {
      // The first step shows at once what is drawn quickly; all else comes with the next one, of the same size if none is larger.
      const isFirst = mine.samples === FEWEST && !mine.whole;
      const seconds = await run(mine.samples, !isFirst);
      if (goal !== mine) continue;
      if (seconds && 2 * mine.samples <= MOST && 2.2 * seconds <= LONGEST) {
        mine.samples *= 2;
      } else if (seconds && isFirst) {
        mine.whole = true;
      } else {
        goal = null;
        // A reader of the screen hears the sentence once it has settled.
        if (seconds) at("told").textContent = shown.lead.join(" ");
      }
    } else {
      goal = null;
      const seconds = await run(quick, false);
      if (seconds && seconds < FRAME / 2 && quick < MOST / 4) quick *= 2;
      if (seconds > FRAME && quick > FEWEST) quick /= 2;
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

// --- Controls ---------------------------------------------------------------------------------------------------------

const remember = () => {
  notice = null;
  past.push(JSON.stringify(state));
  if (past.length > 200) past.shift();
  future = [];
};
const buttons = () => {
  at("undo").disabled = !past.length;
  at("redo").disabled = !future.length;
  const { preset, factors, choices, output } = state;
  at("reset").disabled = !(preset || output || Object.keys(factors).length || Object.keys(choices).length);
  const clean = JSON.stringify(state);
  const fragment = at("reset").disabled ? "" : `#s=${btoa(unescape(encodeURIComponent(clean))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
  history.replaceState(null, "", location.href.split("#")[0] + fragment);
};
const isLink = () => location.hash.startsWith("#s=");
const restored = () => {
  notice = null;
  if (!isLink()) return;
  try {
    const bytes = atob(location.hash.slice(3).replaceAll("-", "+").replaceAll("_", "/"));
    const found = JSON.parse(decodeURIComponent(escape(bytes)));
    const isWhole = given.presets[found.preset] && typeof found.factors === "object" && typeof found.choices === "object";
    if (!isWhole) throw new Error("of another page");
    state = found;
  } catch (error) {
    notice = "The link is damaged, or of another page: this is the study as it was.";
  }
};

const described = async () => {
  const { preset } = state;
  // The factors as the study has them, whatever was changed.
  const answer = await tell({ wanted: "description", text: text(), changes: [] });
  if (answer.cancelled) return described();
  if (answer.broken || answer.answer.refused !== undefined) {
    refuse(answer.broken || answer.answer.refused);
    return false;
  }
  description = { ...answer.answer.done, preset };
  return true;
};
const current = (factor) => state.factors[factor.name] || { distribution: factor.distribution };

// The ends of the middle of a distribution that a slider can move, and the distribution with them moved.
const SLIDES = {
  "uniform": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "log-uniform": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "triangular": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max, mode: Math.min(Math.max(d.mode, min), max) })],
  "truncated-normal": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "normal": [(d) => [d.mean - 2 * d.sd, d.mean + 2 * d.sd], (d, min, max) => ({ ...d, mean: rounded((min + max) / 2), sd: rounded((max - min) / 4) })],
};
const between = {
  "uniform": (min, max) => ({ name: "uniform", min, max }),
  // From 0 it would not begin anywhere.
  "log-uniform": (min, max) => ({ name: "log-uniform", min: min > 0 ? min : rounded(max / 1000), max }),
  "triangular": (min, max) => ({ name: "triangular", min, mode: rounded((min + max) / 2), max }),
  "normal": (min, max) => ({ name: "normal", mean: rounded((min + max) / 2), sd: rounded((max - min) / 4) }),
};

// The ends that a factor has in the study: of a distribution without any, those between which nearly all of its values lie.
const own = (factor) => (SLIDES[factor.distribution.name] ? SLIDES[factor.distribution.name][0](factor.distribution) : [factor.low, factor.high]);

const labelled = (name, field) => make("label", {}, `${words(name)} `, field);
const card = (factor) => {
  const unit = inWords(factor.unit);
  const now = () => current(factor);
  const box = make("fieldset", { className: "factor" });
  box.dataset.factor = factor.name;
  const draw = () => {
    const { fixed, distribution } = now();
    const active = document.activeElement && box.contains(document.activeElement) ? document.activeElement.dataset.key : null;
    const legend = make("legend", { title: factor.description || "" }, words(factor.name) + (unit && `,\u00a0${unit}`));
    const kinds = make("div", { className: "kinds" });
    const choice = make("select", { ariaLabel: `distribution of ${words(factor.name)}` });
    choice.dataset.key = "kind";
    const names = Object.keys(between).filter((name) => name !== "log-uniform" || own(factor)[0] >= 0);
    for (const name of new Set([factor.distribution.name, ...names])) choice.append(make("option", { value: name }, words(name)));
    choice.value = fixed === undefined ? distribution.name : factor.distribution.name;
    choice.disabled = fixed !== undefined;
    choice.onchange = () => {
      remember();
      const [min, max] = ends(distribution);
      if (choice.value === factor.distribution.name) delete state.factors[factor.name];
      else state.factors[factor.name] = { distribution: between[choice.value](rounded(min), rounded(max)) };
      draw();
      changed();
    };
    kinds.append(choice);
    if (factor.can_fix) {
      const fix = make("input", { type: "checkbox", checked: fixed !== undefined });
      fix.dataset.key = "fix";
      fix.onchange = () => {
        remember();
        if (fix.checked) state.factors[factor.name] = { fixed: rounded(factor.nominal), before: now().distribution };
        else if (now().before && JSON.stringify(now().before) !== JSON.stringify(factor.distribution)) state.factors[factor.name] = { distribution: now().before };
        else delete state.factors[factor.name];
        draw();
        changed();
      };
      kinds.append(make("label", {}, fix, "fixed"));
    }
    const meter = make("div", { className: "meter", hidden: true }, make("span"), make("span"));
    meter.title = "Total index: the part of the variance that this factor has, alone and together with others";
    const parts = [legend, kinds, meter];
    const slides = fixed === undefined && SLIDES[distribution.name];
    if (slides) parts.push(slider(factor, distribution, slides));
    else parts.push(make("div", { style: "clear: both" }));
    parts.push(fields(factor, { fixed, distribution }, draw));
    parts.push(box.querySelector(".wrong") || make("p", { className: "wrong", hidden: true }));
    const old = box.querySelector(".meter");
    if (old) meter.replaceChildren(...old.childNodes);
    meter.hidden = !old || old.hidden;
    box.replaceChildren(...parts);
    if (active) {
      const same = box.querySelector(`[data-key="${active}"]`);
      if (same) same.focus();
    }
  };
  const ends = (distribution) => (SLIDES[distribution.name] ? SLIDES[distribution.name][0](distribution) : own(factor));
  draw();
  return box;
};

// Two handles on one track, which has room for half a width on both sides of what the study says.
const STEPS = 1000;
const slider = (factor, distribution, [ends, moved]) => {
  const box = make("div", { className: "slider" });
  const [least, most] = own(factor);
  const width = most - least;
  const [low, high] = ends(distribution);
  // What is nowhere negative in the study is not offered below 0.
  let from = least >= 0 ? Math.max(least / 4, least - width / 2) : least - width / 2;
  let to = most + width / 2;
  if (low < from) from = low;
  if (high > to) to = high;
  const isLog = from > 0 && most / least >= 100;
  const place = (x) => STEPS * (isLog ? Math.log(x / from) / Math.log(to / from) : (x - from) / (to - from));
  const value = (p) => rounded(isLog ? from * (to / from) ** (p / STEPS) : from + (p / STEPS) * (to - from));
  const span = make("div", { className: "span" });
  const unit = factor.unit === "1" ? "" : ` ${inWords(factor.unit)}`;
  const handle = (which, x) => {
    const input = make("input", { type: "range", min: 0, max: STEPS, step: 1, value: place(x) });
    input.ariaLabel = `${which} ${words(factor.name)}`;
    input.dataset.key = which;
    return input;
  };
  const [first, last] = [handle("smallest", low), handle("largest", high)];
  const paint = (a, b) => {
    span.style.left = `${Math.max(0, place(a) / STEPS) * 100}%`;
    span.style.right = `${100 - Math.min(1, place(b) / STEPS) * 100}%`;
    first.setAttribute("aria-valuetext", `${number(a)}${unit}`);
    last.setAttribute("aria-valuetext", `${number(b)}${unit}`);
  };
  let saved = false;
  const move = (input) => {
    if (!saved) remember();
    saved = true;
    if (input === first && first.valueAsNumber >= last.valueAsNumber) first.value = last.valueAsNumber - 1;
    if (input === last && last.valueAsNumber <= first.valueAsNumber) last.value = first.valueAsNumber + 1;
    // The handle that was not moved keeps its number, however many digits it has.
    const [a, b] = ends(current(factor).distribution);
    const min = input === first ? value(first.valueAsNumber) : a;
    const max = input === last ? value(last.valueAsNumber) : b;
    if (!(min < max)) return;
    state.factors[factor.name] = { distribution: moved(current(factor).distribution, min, max) };
    paint(min, max);
    const box = input.closest("fieldset");
    for (const field of box.querySelectorAll(".fields input")) {
      const now = current(factor).distribution[field.dataset.parameter];
      if (now !== undefined) field.value = number(now);
    }
    drag();
  };
  for (const input of [first, last]) {
    input.oninput = () => move(input);
    input.onchange = () => {
      saved = false;
      changed();
    };
  }
  paint(low, high);
  box.append(make("div", { className: "track" }), span, first, last);
  return box;
};

const fields = (factor, { fixed, distribution }, redraw) => {
  const box = make("div", { className: "fields" });
  const field = (name, value, put) => {
    const input = make("input", { type: "number", step: "any", value: number(value) });
    input.dataset.parameter = name;
    input.dataset.key = `field-${name}`;
    input.onchange = () => {
      const typed = input.valueAsNumber;
      if (!Number.isFinite(typed)) {
        input.value = number(value);
        return;
      }
      remember();
      put(typed);
      redraw();
      changed();
    };
    box.append(labelled(name, input));
  };
  if (fixed !== undefined) {
    field("value", fixed, (typed) => { state.factors[factor.name].fixed = typed; });
    return box;
  }
  for (const [name, value] of Object.entries(distribution)) {
    if (typeof value !== "number") continue;
    field(name, value, (typed) => {
      state.factors[factor.name] = { distribution: { ...current(factor).distribution, [name]: typed } };
    });
  }
  return box;
};

const menu = (label, options, value, put) => {
  const select = make("select", { ariaLabel: label });
  options.forEach(([key, text]) => select.append(make("option", { value: key }, text)));
  select.value = value;
  select.onchange = () => {
    remember();
    put(select.value);
  };
  return make("label", {}, label, select);
};
const controls = () => {
  const settings = [];
  if (given.presets.length > 1) {
    const names = given.presets.map(({ title }, place) => [String(place), title]);
    settings.push(menu("study", names, String(state.preset), (value) => {
      state = { preset: Number(value), factors: {}, choices: {}, output: null };
      fresh();
    }));
  }
  const outputs = description.all_outputs.length ? description.all_outputs : description.outputs;
  if (outputs.length > 1) {
    const value = state.output || description.outputs[0].name;
    settings.push(menu("output", outputs.map(({ name }) => [name, words(name)]), value, (value) => {
      state.output = value;
      changed();
    }));
  }
  for (const { name, values, value } of description.choices) {
    const now = state.choices[name] === undefined ? String(value) : state.choices[name];
    settings.push(menu(words(name), values.map((value) => [value, value]), now, (chosen) => {
      if (chosen === String(value)) delete state.choices[name];
      else state.choices[name] = chosen;
      changed();
    }));
  }
  at("settings").replaceChildren(...settings);
  at("factors").replaceChildren(...description.factors.map(card));
};
const changed = () => {
  buttons();
  entitle();
  settle();
};
// The controls show the whole state anew: at once, but for a study that is to be described first.
const fresh = async () => {
  document.body.dataset.samples = "0";
  goal = null;
  interrupt();
  const isOther = () => !description || description.preset !== state.preset;
  if (isOther() && !(await described())) return;
  // While this study was described, another one was chosen.
  if (isOther()) return;
  controls();
  changed();
};
const step = (from, to) => {
  to.push(JSON.stringify(state));
  state = JSON.parse(from.pop());
  fresh();
};
at("undo").onclick = () => step(past, future);
at("redo").onclick = () => step(future, past);
at("reset").onclick = () => {
  remember();
  state = { preset: 0, factors: {}, choices: {}, output: null };
  fresh();
};
addEventListener("keydown", (event) => {
  if (!(event.ctrlKey || event.metaKey) || event.target.matches("input[type=number], textarea")) return;
  if (event.key === "z" && !event.shiftKey && past.length) at("undo").click();
  else if ((event.key === "y" || (event.key === "z" && event.shiftKey)) && future.length) at("redo").click();
  else return;
  event.preventDefault();
});

const offer = async (title, text) => {
  const dialog = at("text");
  dialog.querySelector("h2").textContent = title;
  const area = dialog.querySelector("textarea");
  area.value = text;
  dialog.showModal();
  area.select();
  try {
    await navigator.clipboard.writeText(text);
    dialog.querySelector("h2").textContent = `${title} (copied)`;
  } catch (error) {
    // It is selected, to be copied by hand.
  }
};
const save = (name, type, text) => {
  const url = URL.createObjectURL(new Blob([text], { type }));
  make("a", { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
};
const asked = async (wanted) => {
  goal = null;
  interrupt();
  const answer = await tell(request(wanted, shown.samples || FEWEST));
  if (answer.answer && answer.answer.done !== undefined) return answer.answer.done;
  refuse(answer.broken || (answer.answer && answer.answer.refused) || "");
  return null;
};
const file = (ending, type) => async () => {
  const files = await asked("files");
  // Of several outputs each has its charts.
  const chosen = description.outputs.length > 1 ? `-${state.output || description.outputs[0].name}` : "";
  const own = `${description.name}${ending === "svg" ? chosen : ""}.${ending}`;
  const names = Object.keys(files || {}).filter((name) => name.endsWith(`.${ending}`));
  const name = names.includes(own) ? own : names[0];
  if (name) save(name, type, files[name]);
};
at("json").onclick = file("json", "application/json");
at("csv").onclick = file("csv", "text/csv");
at("svg").onclick = file("svg", "image/svg+xml");
at("toml").onclick = async () => {
  const text = await asked("text");
  if (text !== null) offer("study.toml", text);
};
at("link").onclick = () => offer("Link", location.href);
(async () => {
  if (!engineThread) {
    at("state").textContent = "This browser has no WebAssembly: what you see is the result for the ranges of the study file.";
    return;
  }
  try {
    module = await engineModule;
    worker = engineThread;
    listen();
    addEventListener("hashchange", () => {
      // A jump within the page leaves the settings as they are.
      if (!isLink()) return buttons();
      restored();
      return fresh();
    });
    restored();
    await fresh();
    if (!description) return;
    at("controls").hidden = false;
    // For those who measure.
    window.apportion = { ask: (request) => tell(request).then(({ answer }) => answer) };
  } catch (error) {
    at("state").textContent = `The engine could not be started (${error}): what you see is the result for the ranges of the study file.`;
  }
})();
})();
