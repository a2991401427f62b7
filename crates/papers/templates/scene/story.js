const element = (id) => document.getElementById(id);
const story = JSON.parse(element("scene-data").textContent);
const view = JSON.parse(element("scene-view").textContent);
const geometry = story.geometry;

// ---- The story as functions of time. A number that does not exist is null. ----

const rows = story.samples.time_s.map((_, row) => row).filter((row) => story.samples.time_s[row] !== null);
const column = (name) => rows.map((row) => story.samples[name][row]);
const times = column("time_s");
const columns = Object.fromEntries(Object.keys(story.samples).map((name) => [name, column(name)]));
const first = times[0] ?? 0;
const last = times[times.length - 1] ?? first;
const critical = story.critical.time_s;
const slip = critical !== null && first <= critical && critical <= last ? critical : null;

/** The last sample not after t. */
function rowAt(t) {
  let low = 0, high = times.length - 1;
  while (low < high) {
    const middle = Math.ceil((low + high) / 2);
    if (times[middle] <= t) low = middle; else high = middle - 1;
  }
  return low;
}

/** A number at time t, between the samples by a straight line. */
function at(name, t) {
  const values = columns[name], row = rowAt(t), a = values[row] ?? null, b = values[row + 1] ?? null;
  if (a === null || b === null || row + 1 >= times.length) return a;
  const step = times[row + 1] - times[row];
  return step > 0 ? a + (b - a) * Math.min(1, Math.max(0, (t - times[row]) / step)) : a;
}

const flag = (name, t) => times.length > 0 && columns[name][rowAt(t)];
const atSlip = (t) => slip !== null && Math.abs(t - slip) <= 1e-9 * (last - first);
const largest = (name) => columns[name].reduce((size, value) => Math.max(size, Math.abs(value ?? 0)), 0);
const start = (name) => columns[name].find((value) => value !== null) ?? 0;
const orZero = (value) => value ?? 0;
const orOne = (value) => (value > 0 ? value : 1);

// ---- Numbers as text. ----

function short(value, digits = 3) {
  if (value === null || !Number.isFinite(value)) return "–";
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? value.toExponential(digits - 1) : value.toPrecision(digits);
  const plain = text.includes("e+") && size < 1e6 ? String(Math.round(value)) : text;
  return (size === 0 ? "0" : plain).replace("e+", "e").replaceAll("-", "−");
}
const withUnit = (value, unit) => (value === null ? "–" : `${short(value)} ${unit}`);
/** Decimals with which steps of the story are distinguished. */
const decimals = Math.min(9, Math.max(0, 2 - Math.floor(Math.log10(last - first || 1))));
const clock = (t) => `${t.toFixed(decimals).replaceAll("-", "−")} s`;
function change(value, from) {
  if (value === null || !from) return "";
  const percent = 100 * (value / from - 1);
  return ` (${Math.abs(percent) < 0.05 ? "±0" : (percent > 0 ? "+" : "−") + Math.abs(percent).toFixed(1)} %)`;
}
/** The largest of 1, 2, 5, 10, ... not above a limit. */
function round(limit) {
  if (!(limit > 1e-200 && limit < 1e200)) return 1;
  const power = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].find((step) => step * power <= limit) * power;
}
