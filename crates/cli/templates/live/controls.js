// --- Controls ---------------------------------------------------------------------------------------------------------

// Moves of the same control within a second are one step of undo.
const TOGETHER = 1000;
let latest = { control: null, time: 0 };
const remember = (control = null, goesOn = false) => {
  const now = performance.now();
  const isSame = control && control === latest.control && (goesOn || now - latest.time < TOGETHER);
  latest = { control, time: now };
  notice = null;
  if (isSame) return;
  past.push(JSON.stringify(state));
  if (past.length > 200) past.shift();
  future = [];
};
const buttons = () => {
  const focused = document.activeElement;
  at("undo").disabled = !past.length;
  at("redo").disabled = !future.length;
  const { preset, factors, choices, output } = state;
  at("reset").disabled = !(preset || output || Object.keys(factors).length || Object.keys(choices).length);
  const clean = JSON.stringify(state);
  const fragment = at("reset").disabled ? "" : `#s=${btoa(unescape(encodeURIComponent(clean))).replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "")}`;
  // The last step disables its own button, which some browsers take the focus from at once.
  if (focused.disabled) at(past.length ? "undo" : "redo").focus();
  history.replaceState(null, "", location.href.split("#")[0] + fragment);
};
// The factors and choices as each study has them, whatever was changed.
const descriptions = [];
const described = async (preset) => {
  if (descriptions[preset]) return descriptions[preset];
  const answer = await tell({ wanted: "description", text: given.presets[preset].text, changes: [] });
  if (answer.cancelled) return described(preset);
  if (answer.broken || answer.answer.refused !== undefined) refuse(answer.broken || answer.answer.refused);
  else descriptions[preset] = answer.answer.done;
  return descriptions[preset];
};

const isLink = () => location.hash.startsWith("#s=");
const isRecord = (value) => Object.prototype.toString.call(value) === "[object Object]";
const isPlain = (value) => typeof value === "string" || Number.isFinite(value) || (Array.isArray(value) && value.every(isPlain));
const isDistribution = (value) => isRecord(value) && typeof value.name === "string" && Object.entries(value).every(([key, value]) => /^\w+$/.test(key) && isPlain(value));
const isOf = ({ factors, choices, outputs, all_outputs }, found) => {
  const isChange = ([name, changed]) => {
    if (!isRecord(changed) || !factors.some((factor) => factor.name === name)) return false;
    const { fixed, before, distribution } = changed;
    return fixed === undefined ? isDistribution(distribution) : Number.isFinite(fixed) && (before === undefined || isDistribution(before));
  };
  const isChoice = ([name, value]) => choices.some((choice) => choice.name === name && choice.values.includes(value));
  return isRecord(found.factors) && Object.entries(found.factors).every(isChange) &&
    isRecord(found.choices) && Object.entries(found.choices).every(isChoice) &&
    (found.output === null || outputs.concat(all_outputs).some(({ name }) => name === found.output));
};
// Takes over what the address says: without settings it is the study of the file.
const follow = async () => {
  notice = null;
  let found = unchanged();
  try {
    if (isLink()) {
      found = JSON.parse(decodeURIComponent(escape(atob(location.hash.slice(3).replaceAll("-", "+").replaceAll("_", "/")))));
      if (!Number.isInteger(found.preset) || !given.presets[found.preset]) throw new Error("no such study");
      halt();
      if (!isOf(await described(found.preset), found)) throw new Error("of another page");
    }
    const { preset, factors, choices, output } = found;
    // What the page opens with is not a change.
    if (description && JSON.stringify(found) !== JSON.stringify(state)) remember();
    state = { preset, factors, choices, output };
  } catch (error) {
    notice = "The link is damaged or from another page: this is the original study.";
  }
  return fresh();
};
const current = (factor) => state.factors[factor.name] || { distribution: factor.distribution };

// The ends of the middle of a distribution that a slider can move, and the distribution with them moved.
const normal = (min, max) => {
  const sd = (max - min) / 4;
  return { mean: rounded((min + max) / 2, sd), sd: rounded(sd) };
};
const SLIDES = {
  "uniform": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "log-uniform": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "triangular": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max, mode: Math.min(Math.max(d.mode, min), max) })],
  "truncated-normal": [(d) => [d.min, d.max], (d, min, max) => ({ ...d, min, max })],
  "log-normal": [(d) => [-2, 2].map((k) => Math.exp(d.log_mean + k * d.log_sd)).map((end) => rounded(end, Math.min(1, d.log_sd) * end)), (d, min, max) => {
    const { mean, sd } = normal(Math.log(min), Math.log(max));
    return { ...d, log_mean: mean, log_sd: sd };
  }],
  "normal": [(d) => [-2, 2].map((k) => rounded(d.mean + k * d.sd, d.sd)), (d, min, max) => ({ ...d, ...normal(min, max) })],
};
const between = {
  "uniform": (min, max) => ({ name: "uniform", min, max }),
  // From 0 it would not begin anywhere.
  "log-uniform": (min, max) => ({ name: "log-uniform", min: min > 0 ? min : rounded(max / 1000), max }),
  "triangular": (min, max) => ({ name: "triangular", min, mode: rounded((min + max) / 2, max - min), max }),
  "normal": (min, max) => ({ name: "normal", ...normal(min, max) }),
};

// The ends that a factor has in the study: of a distribution without any, those between which nearly all of its values lie.
const own = (factor) => endsOf(factor, factor.distribution);
const endsOf = (factor, distribution) => {
  if (SLIDES[distribution.name]) return SLIDES[distribution.name][0](distribution);
  return [factor.low, factor.high].map((end) => rounded(end, factor.high - factor.low));
};

// A distribution in words, as the program has it; of many values the first ones.
const plain = (value) => {
  if (Array.isArray(value)) return value.slice(0, 8).map(plain).join("; ") + (value.length > 8 ? `; … (${value.length} in all)` : "");
  if (typeof value === "number") return number(rounded(value, Math.abs(value) / 1e5));
  return typeof value === "object" ? `(${inWords(value)})` : value;
};
const parameter = ([name, value]) => `${words(name)} ${plain(value)}`;
const inWords = ({ name, ...parameters }) => [name, ...Object.entries(parameters).map(parameter)].join(", ");
// What the controls say, for paper.
const tabulate = () => {
  const row = (name, now, before) => make("tr", {}, make("th", { scope: "row" }, words(name)), make("td", {}, now), make("td", {}, now === before ? "" : `changed; in the study ${before}`));
  const factors = description.factors.map((factor) => {
    const unit = unitIn(factor.unit);
    const said = ({ fixed, distribution }) => (fixed === undefined ? inWords(distribution) : `fixed at ${plain(fixed)}`) + (unit && ` (${unit})`);
    return row(factor.name, said(current(factor)), said(factor));
  });
  const choices = description.choices.map(({ name, value }) => row(name, state.choices[name] || String(value), String(value)));
  const head = make("thead", {}, make("tr", {}, ...["factor or choice", "current value", ""].map((text) => make("th", { scope: "col" }, text))));
  const caption = make("caption", {}, "The factors with their distributions, and the choices of the model.");
  const table = make("table", {}, caption, head, make("tbody", {}, ...factors, ...choices));
  at("ranges").replaceChildren(at("ranges-heading"), make("div", { className: "table" }, table));
};

// The keyboard focus stays at the control that is drawn again, or near it.
const keepFocus = (draw) => {
  const active = document.activeElement;
  const box = active.closest("fieldset.factor");
  const within = box ? `[data-factor="${CSS.escape(box.dataset.factor)}"]` : "#settings";
  draw();
  if (!active.dataset.key || active.isConnected) return;
  const same = document.querySelector(`${within} [data-key="${CSS.escape(active.dataset.key)}"]:enabled`) || document.querySelector(`${within} :enabled`);
  if (same) same.focus({ preventScroll: true });
};
const labelled = (name, field) => make("label", {}, `${words(name)} `, field);
const card = (factor) => {
  const unit = unitIn(factor.unit);
  const now = () => current(factor);
  const box = make("fieldset", { className: "factor" });
  box.dataset.factor = factor.name;
  const draw = () => {
    const { fixed, distribution } = now();
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
      const [min, max] = endsOf(factor, distribution);
      if (choice.value === factor.distribution.name) delete state.factors[factor.name];
      else state.factors[factor.name] = { distribution: between[choice.value](min, max) };
      draw();
      changed();
    };
    kinds.append(choice);
    if (factor.can_fix) {
      const fix = make("input", { type: "checkbox", checked: fixed !== undefined });
      fix.dataset.key = "fix";
      fix.onchange = () => {
        remember();
        if (fix.checked) state.factors[factor.name] = { fixed: factor.nominal, before: (state.factors[factor.name] || {}).distribution };
        else if (now().before) state.factors[factor.name] = { distribution: now().before };
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
    keepFocus(() => box.replaceChildren(...parts));
  };
  draw();
  return box;
};

// Two handles on one track, which has room for half a width on both sides of what the study says.
const STEPS = 1000;
const slider = (factor, distribution, [ends, moved]) => {
  const box = make("div", { className: "slider" });
  const [least, most] = own(factor);
  const width = most - least;
  let [low, high] = ends(distribution);
  // What is nowhere negative in the study is not offered below 0.
  let from = least >= 0 ? Math.max(least / 4, least - width / 2) : least - width / 2;
  let to = most + width / 2;
  if (low < from) from = low;
  if (high > to) to = high;
  const isLog = from > 0 && most / least >= 100;
  const place = (x) => STEPS * (isLog ? Math.log(x / from) / Math.log(to / from) : (x - from) / (to - from));
  const value = (p) => (isLog ? rounded(from * (to / from) ** (p / STEPS)) : rounded(from + (p / STEPS) * (to - from), to - from));
  const [span, range] = ["span", "range"].map((className) => make("div", { className }));
  const unit = factor.unit === "1" ? "" : ` ${unitIn(factor.unit)}`;
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
    range.textContent = [a, b].map((x) => brief(x, b - a)).join(" – ");
    first.setAttribute("aria-valuetext", `${brief(a, b - a)}${unit}`);
    last.setAttribute("aria-valuetext", `${brief(b, b - a)}${unit}`);
  };
  let saved = false;
  const move = (input) => {
    remember(`${factor.name} ${input.dataset.key}`, saved);
    saved = true;
    if (input === first && first.valueAsNumber >= last.valueAsNumber) first.value = last.valueAsNumber - 1;
    if (input === last && last.valueAsNumber <= first.valueAsNumber) last.value = first.valueAsNumber + 1;
    // The handle that was not moved keeps its number, however many digits it has.
    const min = input === first ? value(first.valueAsNumber) : low;
    const max = input === last ? value(last.valueAsNumber) : high;
    if (!(min < max)) return;
    [low, high] = [min, max];
    state.factors[factor.name] = { distribution: moved(current(factor).distribution, min, max) };
    paint(min, max);
    const box = input.closest("fieldset");
    for (const field of box.querySelectorAll(".fields input")) {
      const { parameter } = field.dataset;
      field.value = shortened(parameter, current(factor).distribution[parameter], max - min);
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
  box.append(make("div", { className: "track" }), span, range, first, last);
  return box;
};

// Only places within the range are as narrow as it is.
const shortened = (name, value, width) => brief(value, /^(min|mode|max|mean|location|value)$/.test(name) ? width : undefined);
const fields = (factor, { fixed, distribution }, redraw) => {
  const box = make("div", { className: "fields" });
  const [low, high] = endsOf(factor, distribution || factor.distribution);
  const field = (name, value, put) => {
    // The study keeps all digits until others are typed.
    const short = shortened(name, value, high - low);
    const input = make("input", { type: "number", step: "any", value: short, title: number(value) });
    input.dataset.parameter = name;
    input.dataset.key = `field-${name}`;
    input.onchange = () => {
      const typed = input.valueAsNumber;
      if (!Number.isFinite(typed) || typed === Number(short)) {
        input.value = short;
        return;
      }
      remember(`${factor.name} ${name}`);
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
    if (name === "name") continue;
    if (typeof value !== "number") box.append(make("span", { className: "values" }, parameter([name, value])));
    else field(name, value, (typed) => {
      state.factors[factor.name] = { distribution: { ...current(factor).distribution, [name]: typed } };
    });
  }
  return box;
};

const menu = (label, options, value, put) => {
  const select = make("select", { ariaLabel: label });
  select.dataset.key = label;
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
      state = unchanged(Number(value));
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
  keepFocus(() => {
    at("settings").replaceChildren(...settings);
    at("factors").replaceChildren(...description.factors.map(card));
  });
};
const changed = () => {
  buttons();
  entitle();
  tabulate();
  settle();
};
const halt = () => {
  document.body.dataset.samples = "0";
  goal = null;
  interrupt();
};
// The controls show the whole state again: at once, but for a study that is to be described first.
const fresh = async () => {
  halt();
  const { preset } = state;
  if (!descriptions[preset] && !(await described(preset))) return;
  // While this study was described, another one was chosen.
  if (state.preset !== preset) return;
  description = descriptions[preset];
  controls();
  changed();
};
const step = (from, to) => {
  latest.control = null;
  to.push(JSON.stringify(state));
  state = JSON.parse(from.pop());
  fresh();
};
at("undo").onclick = () => step(past, future);
at("redo").onclick = () => step(future, past);
at("reset").onclick = () => {
  remember();
  state = unchanged();
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
// A copy is of the settings and of the number of base points shown. The doubling waits for it, and goes on.
const asked = async (wanted) => {
  while (shown.settings !== JSON.stringify(state)) {
    if (refused.settings === JSON.stringify(state)) {
      refuse(refused.problem);
      at("refused").scrollIntoView({ block: "nearest" });
      return null;
    }
    await new Promise((resolve) => hearers.push(resolve));
  }
  if (flying) cancel();
  const mine = tell(request(wanted, shown.samples));
  asking = mine;
  const { answer, broken } = await mine;
  if (asking === mine) asking = null;
  if (broken) cancel();
  if (answer && answer.done !== undefined) return answer.done;
  refuse(broken || (answer && answer.refused), false);
  return null;
};
const file = (type, ...endings) => async () => {
  const files = await asked("files");
  // Of several outputs each has its charts.
  const chosen = endings[0].endsWith("svg") && description.outputs.length > 1 ? `-${state.output || description.outputs[0].name}` : "";
  // The engine calls every study the same.
  const name = endings.flatMap((ending) => [`${chosen}${ending}`, ending]).find((end) => files && `${description.name}${end}` in files);
  if (name) save(`${given.presets[state.preset].name}${name}`, type, files[`${description.name}${name}`]);
};
at("json").onclick = file("application/json", ".json");
at("csv").onclick = file("text/csv", ".csv");
at("svg").onclick = file("image/svg+xml", "-indices.svg", "-along.svg");
at("toml").onclick = async () => {
  const text = await asked("text");
  if (text !== null) offer("study.toml", text);
};
at("link").onclick = () => offer("Link", location.href);
(async () => {
  if (!engineThread) {
    at("state").textContent = "This browser has no WebAssembly: this is the result for the ranges of the study file.";
    return;
  }
  try {
    module = await engineModule;
    worker = engineThread;
    listen();
    // A jump within the page leaves the settings as they are.
    addEventListener("hashchange", () => (location.hash && !isLink() ? buttons() : follow()));
    await follow();
    if (!description) return;
    at("controls").hidden = false;
    // For those who measure.
    window.apportion = { ask: (request) => tell(request).then(({ answer }) => answer) };
  } catch (error) {
    at("state").textContent = `The engine could not be started (${error}): this is the result for the ranges of the study file.`;
  }
})();
