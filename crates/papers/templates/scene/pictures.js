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
  add(svg, "rect", { x: -2, y: 86, width: width + 4, height: 24, fill: "var(--paper)" });
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
