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
