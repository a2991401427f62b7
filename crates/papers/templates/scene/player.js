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
      add(svg, "text", { class: "small halo", x: px(turn ? place - 5 : Math.max(place + 5, 70)), y: top - 8, "text-anchor": turn ? "end" : "start" },
        `slip at ${short(slip)} s, ${withUnit(story.critical.critical_force_nN, "nN")}`);
    }
    const parts = CURVES.map(([name, kind]) => ({
      name,
      later: add(svg, "path", { class: `curve ${kind} later` }),
      sooner: add(svg, "path", { class: `curve ${kind}` }),
    }));
    const cursor = add(svg, "line", { class: "thin", y1: top - 4, y2: bottom });
    const dots = CURVES.map(([, kind]) => add(svg, "circle", { class: `dot ${kind}`, r: 4.5, stroke: "var(--paper)" }));
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

// ---- Numbers next to the pictures. ----

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

// On paper the scene is shown at the slip.
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
