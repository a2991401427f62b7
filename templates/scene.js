(() => {
"use strict";

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
/** Decimals with which steps of the story are told apart. */
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

// ---- Drawing. ----

function add(parent, tag, attributes, text) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", tag);
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
  if (text !== undefined) node.textContent = text;
  parent.append(node);
  return node;
}
function set(node, attributes) {
  for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
}
const px = (value) => value.toFixed(2);
const path = (points) => points.map(([x, y], i) => `${i ? "L" : "M"}${px(x)} ${px(y)}`).join("");

/** The multiples of a step in a range: few, whatever the range. */
function ticks(from, to, step) {
  const slack = 1e-9 * (to - from), begin = Math.ceil((from - slack) / step);
  return Array.from({ length: 20 }, (_, i) => (begin + i) * step).filter((value) => value >= from - slack && value <= to + slack);
}

/** An arrow that can be moved; one too short for a head is not shown. */
function arrow(parent, kind) {
  const node = add(parent, "path", { class: `arrow ${kind}` });
  return ([x, y], [dx, dy], head = 8) => {
    const size = Math.hypot(dx, dy), show = size > 1.2 * head;
    node.setAttribute("visibility", show ? "visible" : "hidden");
    if (!show) return;
    const [ux, uy] = [dx / size, dy / size], [tx, ty] = [x + dx, y + dy], [bx, by] = [tx - head * ux, ty - head * uy];
    const half = 0.42 * head;
    set(node, { d: `M${px(x)} ${px(y)}L${px(bx)} ${px(by)}M${px(tx)} ${px(ty)}L${px(bx - half * uy)} ${px(by + half * ux)}L${px(bx + half * uy)} ${px(by - half * ux)}Z` });
  };
}

/** Marks on the substrate at round distances; gives a function that moves them. */
function marks(parent, { y, spacing, width }) {
  const group = add(parent, "g", { class: "tick" });
  const gap = Math.max(5, spacing);
  for (let x = -gap; x < width + 2 * gap; x += gap) {
    add(group, "line", { x1: px(x), y1: y, x2: px(x - 7), y2: y + 9 });
  }
  return (shift) => group.setAttribute("transform", `translate(${px(((shift % gap) + gap) % gap)} 0)`);
}

/** A text such as "twist θ = 1.01 mrad": a symbol with its index, and a part that changes, which is given back. */
function quantity(parent, place, [words, symbol, index]) {
  const text = add(parent, "text", { class: "small", ...place }, `${words} `);
  add(text, "tspan", { "font-style": "italic" }, symbol);
  if (index) add(text, "tspan", { dy: 3, "font-size": 9 }, index);
  return add(text, "tspan", index ? { dy: -3 } : {});
}

// ---- The probe from the front. ----

function probe() {
  const svg = element("probe"), width = 360, ground = 232, tall = 112;
  const height = orOne(geometry.height_nm), scale = tall / height;
  const half = Math.min((orOne(geometry.width_nm) / 2) * scale, 118);
  const cut = (orOne(geometry.width_nm) / 2) * scale > 118;
  const thick = Math.min(60, Math.max(4, orOne(geometry.thickness_nm) * scale));
  const x0 = 160, f = view.probe_factor;

  add(svg, "rect", { class: "ground", x: 0, y: ground, width, height: 30 });
  add(svg, "line", { class: "surface", x1: 0, y1: ground, x2: width, y2: ground });
  const shiftMarks = marks(svg, { y: ground, spacing: 18, width });
  const lens = add(svg, "circle", { class: "thin", cx: 0, cy: ground - 3, r: 11, "stroke-dasharray": "2 2" });

  // About the tip base, which is the origin.
  const notch = (x, sign) => [[x, -thick], [x - 3 * sign, -thick * 0.66], [x + 3 * sign, -thick * 0.33], [x, 0]];
  const end = (x, sign) => (cut ? notch(x, sign) : [[x, -thick], [x, 0]]);
  const bar = path([...end(-half, -1), ...end(half, 1).reverse()]) + "Z";
  const foot = 0.25 * tall;
  const cone = path([[-foot, 0], [foot, 0], [1.2, tall - 1], [-1.2, tall - 1]]) + "Z";
  const ghost = add(svg, "g", { class: "ghost", transform: `translate(${x0} ${ground - tall - 4})` });
  add(ghost, "path", { d: bar });
  add(ghost, "path", { d: cone });
  const body = add(svg, "g", {});
  add(body, "path", { class: "steel", d: cone });
  add(body, "path", { class: "steel", d: bar });
  add(body, "circle", { cx: 0, cy: 0, r: 2.4, fill: "var(--ink)" });
  // Too small to be to scale.
  const dot = add(svg, "circle", { class: "gold", cx: 0, cy: ground - 3, r: 3 });

  const twist = quantity(svg, { x: 10, y: 20 }, ["twist", "θ"]);
  const base = quantity(svg, { x: 10, y: 37 }, ["tip base", "y", "P"]);
  const deflection = quantity(svg, { x: width - 10, y: 20, "text-anchor": "end" }, ["deflection", "z", "P"]);
  quantity(svg, { x: width - 10, y: 37, "text-anchor": "end" }, ["tip height", "H"]).textContent = ` = ${short(height / 1e3)} µm`;
  quantity(svg, { x: width - 10, y: 54, "text-anchor": "end" }, ["cantilever", "w"]).textContent =
    ` = ${short(geometry.width_nm / 1e3)} µm${cut ? ", cut" : ""}`;
  const motion = arrow(svg, "plain");
  motion([width - 62, ground + 17], [46, 0], 7);
  add(svg, "text", { class: "small halo", x: width - 70, y: ground + 21, "text-anchor": "end" }, "substrate");

  return (t) => {
    const angle = f * orZero(at("twist_rad", t)), lateral = f * scale * orZero(at("base_lateral_nm", t));
    const apex = x0 + lateral + tall * Math.sin(angle), y = ground - 4 - tall * Math.cos(angle);
    body.setAttribute("transform", `translate(${px(x0 + lateral)} ${px(y)}) rotate(${px((-angle * 180) / Math.PI)})`);
    const side = apex - 3 * Math.sin(Math.min(1.5, orZero(geometry.contact_angle_rad)));
    dot.setAttribute("cx", px(side));
    lens.setAttribute("cx", px(side));
    shiftMarks(f * scale * orZero(at("substrate_position_nm", t)));
    const said = (name, factor, unit) => {
      const value = at(name, t);
      return ` = ${withUnit(value === null ? null : factor * value, unit)}`;
    };
    twist.textContent = said("twist_rad", 1e3, "mrad");
    base.textContent = said("base_lateral_nm", 1, "nm");
    deflection.textContent = said("deflection_nm", 1e-3, "µm");
  };
}

// ---- The particle under the tip. ----

function particle() {
  const svg = element("particle"), width = 360, ground = 198, radius = 64, x0 = 118;
  const R = orOne(geometry.particle_radius_nm), scale = radius / R, f = view.travel_factor * scale;
  const phi = orZero(geometry.contact_angle_rad), tipRadius = Math.min(4000, Math.max(1.5, orOne(geometry.tip_radius_nm) * scale));
  const step = round(30 / f);
  const all = add(svg, "g", {});

  add(all, "circle", { class: "ghost", cx: x0, cy: ground - radius, r: radius });
  const slope = 14 * Math.PI / 180, [c, s] = [Math.cos(slope), Math.sin(slope)], long = 4000;
  const tip = add(all, "path", {
    class: "steel",
    d: `M${px(-tipRadius * c)} ${px(tipRadius * s)}A${tipRadius} ${tipRadius} 0 0 0 ${px(tipRadius * c)} ${px(tipRadius * s)}` +
      `L${px(tipRadius * c + long * s)} ${px(tipRadius * s - long * c)}L${px(-tipRadius * c - long * s)} ${px(tipRadius * s - long * c)}Z`,
  });
  // In front of a tip larger than the particle, which would reach below the surface.
  add(all, "rect", { class: "ground", x: 0, y: ground, width, height: 70 });
  add(all, "line", { class: "surface", x1: 0, y1: ground, x2: width, y2: ground });
  const shiftMarks = marks(all, { y: ground, spacing: step * f, width });
  const ball = add(all, "circle", { class: "gold", r: radius });
  const grip = add(all, "line", { class: "grip" });
  const normal = arrow(all, "normal"), lateral = arrow(all, "lateral"), push = arrow(all, "push");
  const label = (text) => {
    const node = add(all, "text", { class: "small halo", "font-style": "italic" }, "F");
    add(node, "tspan", { dy: 3, "font-size": 9 }, text);
    return node;
  };
  const [labelPush, labelLateral, labelNormal] = [label("T"), label("Y"), label("Z")];

  // Where the particle stood on the substrate at the start, and how far it is from there.
  const origin = add(all, "g", {});
  add(origin, "path", { class: "start", d: `M0 ${ground + 1}l-5 9h10z` });
  const away = arrow(all, "slip-line"), awayText = add(all, "text", { class: "small", y: ground + 39, "text-anchor": "middle" });
  add(all, "text", { class: "small", x: width - 8, y: 253, "text-anchor": "end" }, `marks every ${short(step, 1)} nm`);
  const badge = add(svg, "g", { class: "badge" });
  add(badge, "rect", { x: 10, y: 10, width: 92, height: 22, rx: 3 });
  const badgeText = add(badge, "text", { x: 56, y: 25.5 });
  const strongest = orOne(largest("tip_force_nN"));
  // Beyond these the theories are stretched further than a picture can be.
  const depth = (name, t) => scale * Math.min(0.3 * R, orZero(at(name, t)));
  const from = { particle: start("particle_position_nm"), substrate: start("substrate_position_nm") };

  return (t) => {
    const x = x0 + f * (orZero(at("particle_position_nm", t)) - from.particle);
    const ys = ground - radius + depth("substrate_indentation_nm", t);
    set(ball, { cx: px(x), cy: px(ys) });
    const reach = radius + tipRadius - depth("tip_indentation_nm", t);
    tip.setAttribute("transform", `translate(${px(x + reach * Math.sin(phi))} ${px(ys - reach * Math.cos(phi))})`);
    const contact = [x + radius * Math.sin(phi), ys - radius * Math.cos(phi)];
    const k = (1.25 * radius) / strongest;
    const [fy, fz] = [-k * orZero(at("lateral_force_nN", t)), k * orZero(at("normal_force_nN", t))];
    normal(contact, [0, fz]);
    lateral(contact, [fy, 0]);
    push(contact, [fy, fz], 10);
    const write = (node, dx, dy, anchor, show) =>
      set(node, { x: px(contact[0] + dx), y: px(contact[1] + dy), "text-anchor": anchor, visibility: show ? "visible" : "hidden" });
    write(labelPush, fy - 6, fz + 4, "end", Math.hypot(fy, fz) > 12);
    write(labelLateral, fy - 2, -6, "start", Math.abs(fy) > 12);
    write(labelNormal, 6, fz, "start", Math.abs(fz) > 12);

    const slipping = flag("slipping", t), a = Math.min(radius, scale * orZero(at("substrate_contact_radius_nm", t)));
    grip.classList.toggle("slipping", slipping);
    set(grip, { x1: px(x - a), y1: ground, x2: px(x + a), y2: ground });
    const travel = f * (orZero(at("substrate_position_nm", t)) - from.substrate), mark = x0 + travel;
    shiftMarks(x0 + travel);
    origin.setAttribute("transform", `translate(${px(mark)} 0)`);
    const edge = Math.min(width - 10, Math.max(10, mark));
    away([edge, ground + 21], [x - edge, 0], 7);
    const apart = Math.abs(mark - x) > 12;
    awayText.textContent = apart ? withUnit(at("relative_position_nm", t), "nm on the substrate") : "";
    awayText.setAttribute("x", px(Math.min(width - 80, Math.max(80, (edge + x) / 2))));
    badge.classList.toggle("slipping", slipping || atSlip(t));
    badgeText.textContent = atSlip(t) ? "SLIP" : slipping ? "SLIPPING" : "STICKING";
  };
}

// ---- The contacts, enlarged. ----

function contact(id, { at: place, radius, top, bottom }) {
  const svg = element(id), width = 180, level = 50, half = width / 2;
  const names = { a: `${place}_contact_radius_nm`, depth: `${place}_indentation_nm` };
  const widest = orOne(largest(names.a));
  const scale = 52 / widest;
  const tallest = Math.max(largest(names.depth), (widest * widest) / (2 * radius));
  const stretch = round(22 / (tallest * scale));
  const lower = add(svg, "path", { class: bottom }), upper = add(svg, "path", { class: top, "fill-opacity": 0.9 });
  add(svg, "line", { class: "pale", x1: 0, y1: level, x2: width, y2: level, "stroke-dasharray": "3 3" });
  const a0 = start(names.a) * scale;
  for (const x of [half - a0, half + a0]) add(svg, "line", { class: "ghost", x1: px(x), y1: level - 24, x2: px(x), y2: level + 30 });
  const touch = add(svg, "path", { class: "grip", fill: "none" });
  add(svg, "rect", { x: -2, y: 86, width: width + 4, height: 24, fill: "#ffffff" });
  const text = add(svg, "text", { class: "small", x: half, y: 101, "text-anchor": "middle", "font-size": 11 });
  add(svg, "text", { class: "halo", x: width - 5, y: 12, "text-anchor": "end", "font-size": 9.5 }, `heights × ${short(stretch, 1)}`);

  return (t) => {
    const a = orZero(at(names.a, t)), depth = orZero(at(names.depth, t));
    const up = (nm) => level - nm * scale * stretch;
    const ball = (x) => -depth + (x * x) / (2 * radius);
    const rim = ball(a);
    const sphere = [], flat = [], touching = [];
    // Somewhat beyond the frame, so that its sides show no outline.
    for (let i = -12; i <= 132; i++) {
      const xp = (width * i) / 120, x = (xp - half) / scale, inside = Math.abs(x) <= a;
      sphere.push([xp, up(ball(x))]);
      flat.push([xp, up(inside ? ball(x) : rim * (a / Math.abs(x)) ** 2)]);
      if (inside) touching.push([xp, up(ball(x))]);
    }
    lower.setAttribute("d", `${path(flat)}L${1.1 * width} 120L${-0.1 * width} 120Z`);
    upper.setAttribute("d", `${path(sphere)}L${1.1 * width} -200L${-0.1 * width} -200Z`);
    touch.setAttribute("d", touching.length > 1 ? path(touching) : "");
    touch.classList.toggle("slipping", place === "substrate" && flag("slipping", t));
    text.textContent = `a ${withUnit(at(names.a, t), "nm")}${change(at(names.a, t), start(names.a))}, δ ${withUnit(at(names.depth, t), "nm")}`;
  };
}

// ---- The forces, growing with time. ----

const CURVES = [["normal_force_nN", "normal"], ["lateral_force_nN", "lateral"], ["tip_force_nN", "push"]];

function force() {
  const svg = element("force"), height = 220, top = 20, bottom = 184, left = 48;
  let right = 0, draw = () => {};
  const highest = 1.08 * orOne(Math.max(...CURVES.map(([name]) => largest(name)), slip === null ? 0 : orZero(story.critical.critical_force_nN)));
  const lowest = Math.min(0, ...CURVES.map(([name]) => columns[name].reduce((low, v) => Math.min(low, v ?? 0), 0)));
  const span = last - first || 1;
  const x = (t) => left + ((t - first) / span) * (right - left);
  const y = (value) => bottom - ((value - lowest) / (highest - lowest)) * (bottom - top);

  /** The curves up to time t, or from it; broken where there is no number. */
  const line = (name, from, to) => {
    const points = [[from, at(name, from)]];
    times.forEach((time, row) => { if (time > from && time < to) points.push([time, columns[name][row]]); });
    points.push([to, at(name, to)]);
    let d = "", pen = "M";
    for (const [time, value] of points) {
      if (value === null) { pen = "M"; continue; }
      d += `${pen}${px(x(time))} ${px(y(value))}`;
      pen = "L";
    }
    return d;
  };

  function lay() {
    const width = Math.max(260, svg.clientWidth || 800);
    right = width - 12;
    svg.replaceChildren();
    set(svg, { viewBox: `0 0 ${width} ${height}` });
    for (const value of ticks(lowest, highest, round((highest - lowest) / 3.5))) {
      const place = px(y(value));
      add(svg, "line", { class: "pale", x1: left, y1: place, x2: right, y2: place, opacity: 0.5 });
      add(svg, "text", { class: "small", x: left - 6, y: px(y(value) + 4), "text-anchor": "end" },
        String(+value.toPrecision(6)).replaceAll("-", "−"));
    }
    const stepT = round(span / (width < 500 ? 3 : 6));
    const places = Math.max(0, -Math.floor(Math.log10(stepT)));
    for (const time of ticks(first, last, stepT)) {
      const place = x(time);
      add(svg, "line", { class: "thin", x1: px(place), y1: bottom, x2: px(place), y2: bottom + 4 });
      add(svg, "text", { class: "small", x: px(place), y: bottom + 17, "text-anchor": "middle" }, places > 5 ? short(time) : time.toFixed(places));
    }
    add(svg, "line", { class: "thin", x1: left, y1: bottom, x2: right, y2: bottom });
    add(svg, "text", { class: "small", x: right, y: bottom + 33, "text-anchor": "end" }, "time (s)");
    add(svg, "text", { class: "small", x: 2, y: 11 }, "force (nN)");
    if (slip !== null) {
      const place = x(slip), turn = place > 0.7 * width;
      add(svg, "line", { class: "ghost", x1: px(place), y1: top - 4, x2: px(place), y2: bottom });
      add(svg, "text", { class: "small halo", x: px(place + (turn ? -5 : 5)), y: top - 8, "text-anchor": turn ? "end" : "start" },
        `slip at ${short(slip)} s, ${withUnit(story.critical.critical_force_nN, "nN")}`);
    }
    const parts = CURVES.map(([name, kind]) => ({
      name,
      later: add(svg, "path", { class: `curve ${kind} later` }),
      sooner: add(svg, "path", { class: `curve ${kind}` }),
    }));
    const cursor = add(svg, "line", { class: "thin", y1: top - 4, y2: bottom });
    const dots = CURVES.map(([, kind]) => add(svg, "circle", { class: `dot ${kind}`, r: 4.5, stroke: "#ffffff" }));
    draw = (t) => {
      for (const { name, sooner, later } of parts) {
        set(sooner, { d: line(name, first, t) });
        set(later, { d: line(name, t, last) });
      }
      set(cursor, { x1: px(x(t)), x2: px(x(t)) });
      dots.forEach((dot, i) => {
        const value = at(CURVES[i][0], t);
        set(dot, { cx: px(x(t)), cy: px(y(orZero(value))), visibility: value === null ? "hidden" : "visible" });
      });
    };
  }
  lay();
  new ResizeObserver(() => { lay(); draw(now); }).observe(svg);
  const seek = (event) => {
    const box = svg.getBoundingClientRect();
    const place = ((event.clientX - box.left) / box.width) * (right + 12);
    pause();
    show(first + ((place - left) / (right - left)) * (last - first));
  };
  svg.addEventListener("pointerdown", (event) => { svg.setPointerCapture(event.pointerId); seek(event); });
  svg.addEventListener("pointermove", (event) => { if (svg.hasPointerCapture(event.pointerId)) seek(event); });
  return (t) => draw(t);
}

// ---- Numbers beside the pictures. ----

function readings(t) {
  for (const name of ["tip_force_nN", "lateral_force_nN", "normal_force_nN"]) {
    element(`r-${name}`).textContent = withUnit(at(name, t), "nN");
  }
  for (const name of ["substrate_position_nm", "relative_position_nm"]) {
    element(`r-${name}`).textContent = withUnit(at(name, t), "nm");
  }
  const angle = at("force_angle_rad", t);
  element("r-force_angle_rad").textContent = angle === null ? "–" : `${short((angle * 180) / Math.PI)}°`;
  element("r-state").textContent = state(t);
  element("r-state").classList.toggle("slipping", flag("slipping", t) || atSlip(t));
}

function state(t) {
  const others = [["tip_slip", "tip would slip"], ["rolling", "would roll"], ["spin", "would spin"]];
  const said = others.filter(([name]) => flag(name, t)).map(([, words]) => words);
  return [atSlip(t) ? "slip" : flag("slipping", t) ? "slipping" : "sticking", ...said].join(", ");
}

// ---- Time. ----

const [play, slider, toSlip, speed] = ["play", "time", "to-slip", "speed"].map(element);
/** Seconds in which the whole story is shown at speed 1. */
const SHOWN_IN = 8;
let now = first, playing = false, frame = null, before = null;

const pictures = [
  probe(),
  particle(),
  contact("tip-contact", {
    at: "tip",
    radius: 1 / (1 / orOne(geometry.particle_radius_nm) + 1 / orOne(geometry.tip_radius_nm)),
    top: "steel",
    bottom: "gold",
  }),
  contact("substrate-contact", { at: "substrate", radius: orOne(geometry.particle_radius_nm), top: "gold", bottom: "soil" }),
  force(),
  readings,
];

function show(t) {
  now = Math.min(last, Math.max(first, t));
  pictures.forEach((draw) => draw(now));
  slider.value = last > first ? Math.round((1000 * (now - first)) / (last - first)) : 0;
  slider.setAttribute("aria-valuetext", `${clock(now)}, ${withUnit(at("tip_force_nN", now), "nN")}, ${state(now)}`);
  element("clock").textContent = clock(now);
}

function label() {
  play.textContent = playing ? "Pause" : "Play";
}

function pause() {
  playing = false;
  if (frame !== null) cancelAnimationFrame(frame);
  frame = null;
  label();
}

function run() {
  if (!(last > first)) return;
  if (now >= last) show(first);
  playing = true;
  before = null;
  frame = requestAnimationFrame(advance);
  label();
}

function advance(stamp) {
  // A page that was hidden must not jump.
  const passed = before === null ? 0 : Math.min(0.1, (stamp - before) / 1000);
  before = stamp;
  show(now + (passed * Number(speed.value) * (last - first)) / SHOWN_IN);
  if (now >= last) pause();
  else frame = requestAnimationFrame(advance);
}

function pace() {
  const seconds = SHOWN_IN / Number(speed.value);
  element("pace").textContent = last > first ? `The ${short(last - first)} s of the story are shown in ${seconds} s.` : "";
}

play.addEventListener("click", () => (playing ? pause() : run()));
slider.addEventListener("input", () => { pause(); show(first + (Number(slider.value) / 1000) * (last - first)); });
toSlip.addEventListener("click", () => { pause(); show(slip); });
speed.addEventListener("change", pace);
toSlip.disabled = slip === null;
play.disabled = slider.disabled = speed.disabled = !(last > first);

// On paper the scene stands still at the slip.
let kept = null;
addEventListener("beforeprint", () => { kept = { now, playing }; pause(); show(slip ?? last); });
addEventListener("afterprint", () => { if (kept) { show(kept.now); if (kept.playing) run(); } kept = null; });

pace();
label();
if (matchMedia("(prefers-reduced-motion: reduce)").matches) {
  show(slip ?? first);
} else {
  show(first);
  run();
}
})();
