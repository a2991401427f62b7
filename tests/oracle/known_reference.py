"""Mean, variance, first-order and total indices of the engineering functions, by Gauss-Legendre quadrature, frozen in
known-reference.json with an error: the largest difference between two orders of the rules.

Flood and wing weight are sums of products, so that integrals over one or two inputs are enough; borehole, OTL circuit
and piston are tensor products over all inputs that act nonlinearly. With numpy 2.4.

Run from anywhere: python3 known_reference.py
"""

import json
import pathlib

import numpy as np


def rule(low, high, order, density=None, breaks=()):
    """Nodes and weights (summing to 1) for a density on [low, high]; `breaks` are its kinks."""
    x, w = np.polynomial.legendre.leggauss(order)
    nodes, weights = [], []
    for a, b in zip([low, *breaks], [*breaks, high]):
        t = (a + b) / 2 + (b - a) / 2 * x
        nodes.append(t)
        weights.append((b - a) / 2 * w * (density(t) if density else 1))
    nodes, weights = np.concatenate(nodes), np.concatenate(weights)
    return nodes, weights / weights.sum()


def normal(mean, sd, low, high, order):
    return rule(low, high, order, lambda t: np.exp(-0.5 * ((t - mean) / sd) ** 2))


def triangular(low, mode, high, order):
    return rule(low, high, order, lambda t: np.minimum((t - low) / (mode - low), (high - t) / (high - mode)), [mode])


def tensor(function, rules):
    """Indices of a function on the grid of the rules."""
    d = len(rules)
    grids = np.meshgrid(*[nodes for nodes, _ in rules], indexing="ij", sparse=True)
    y = function(*grids)

    def mean_over(values, axes):
        for axis in sorted(axes, reverse=True):
            values = np.tensordot(values, rules[axis][1], axes=([axis], [0]))
        return values

    mean = float(mean_over(y, range(d)))
    y = y - mean
    variance = float(mean_over(y**2, range(d)))
    first, total = [], []
    for i in range(d):
        others = [j for j in range(d) if j != i]
        first.append(float(rules[i][1] @ mean_over(y, others) ** 2) / variance)
        conditional = np.tensordot(y, rules[i][1], axes=([i], [0]))
        deviation = (y - np.expand_dims(conditional, i)) ** 2
        total.append(float(mean_over(deviation, range(d))) / variance)
    return [mean, variance, first, total]


def moments(values, weights):
    m = weights @ values
    return m, weights @ (values - m) ** 2


def flood(order):
    q, wq = rule(500, 3000, 2 * order, lambda t: np.exp(-(z := (t - 1013) / 558) - np.exp(-z)))
    ks, wks = normal(30, 8, 15, 110, 4 * order)
    zv, wzv = triangular(49, 50, 51, order)
    zm, wzm = triangular(54, 55, 56, order)
    cb, wcb = triangular(55, 55.5, 56, order)
    le, wle = triangular(4990, 5000, 5010, order)
    b, wb = triangular(295, 300, 305, order)
    parts = [moments(q**0.6, wq), moments(ks**-0.6, wks), moments(le**0.3, wle), moments(b**-0.6, wb)]
    z = (zm[None, :] - zv[:, None]) ** -0.3
    mz = float(wzv @ z @ wzm)
    vz = float(wzv @ (z - mz) ** 2 @ wzm)
    c1 = np.prod([m for m, _ in parts])
    c2 = np.prod([m * m + v for m, v in parts])
    mean_h, second_h = c1 * mz, c2 * (vz + mz * mz)
    variance_h = second_h - mean_h**2
    dzv = zv - wzv @ zv
    z_of_zv, z_of_zm = z @ wzm, wzv @ z
    cov = float(wzv @ (dzv * z_of_zv))
    v_zv, v_hd, v_cb = float(wzv @ dzv**2), 1 / 3, moments(cb, wcb)[1]
    variance = variance_h + v_zv + 2 * c1 * cov + v_hd + v_cb
    # Of H = prod p_k z: one factor's own variance times the others' squared means, or second moments.
    vi = lambda k: parts[k][1] * (mean_h / parts[k][0]) ** 2
    vt = lambda k: parts[k][1] * second_h / (parts[k][0] ** 2 + parts[k][1])
    v1_zv = float(wzv @ (dzv + c1 * (z_of_zv - mz)) ** 2)
    vt_zv = v_zv + 2 * c1 * cov + c2 * float(wzm @ (wzv @ (z - z_of_zm[None, :]) ** 2))
    v1_zm = c1**2 * float(wzm @ (z_of_zm - mz) ** 2)
    vt_zm = c2 * float(wzv @ ((z - z_of_zv[:, None]) ** 2 @ wzm))
    mean = mean_h + 50 - 8 - 55.5
    first = [vi(0), vi(1), v1_zv, v1_zm, v_hd, v_cb, vi(2), vi(3)]
    total = [vt(0), vt(1), vt_zv, vt_zm, v_hd, v_cb, vt(2), vt(3)]
    return [float(mean), float(variance), [float(v / variance) for v in first], [float(v / variance) for v in total]]


def wing_weight(order):
    boxes = [(150, 200), (220, 300), (6, 10), (-10, 10), (16, 45), (0.5, 1), (0.08, 0.18), (2.5, 6), (1700, 2500)]
    powers = [0.758, 0.0035, 0.6, None, 0.006, 0.04, -0.3, 0.49, 0.49]
    rules = [rule(a, b, order) for a, b in boxes]
    value = lambda x, p: np.cos(np.radians(x)) ** -0.9 if p is None else x**p
    g = [moments(value(x, p), w) for (x, w), p in zip(rules, powers)]
    scale = 0.036 * 100**-0.3
    mean_p = scale * np.prod([m for m, _ in g])
    second_p = scale**2 * np.prod([m * m + v for m, v in g])
    (sw, wsw), (wp, wwp) = rules[0], rule(0.025, 0.08, order)
    (ms, vs), (mp, vp) = moments(sw, wsw), moments(wp, wwp)
    cov = wsw @ ((sw - ms) * sw**0.758)  # of Sw and Sw^0.758
    rest1, rest2 = mean_p / g[0][0], second_p / (g[0][0] ** 2 + g[0][1])
    variance = second_p - mean_p**2 + (ms**2 + vs) * (mp**2 + vp) - (ms * mp) ** 2 + 2 * mp * rest1 * cov
    first = [mean_p**2 * v / m**2 for m, v in g] + [ms**2 * vp]
    total = [second_p * v / (m * m + v) for m, v in g] + [(ms**2 + vs) * vp]
    first[0] = rest1**2 * g[0][1] + mp**2 * vs + 2 * mp * rest1 * cov
    total[0] = rest2 * g[0][1] + (mp**2 + vp) * vs + 2 * mp * rest1 * cov
    mean = mean_p + ms * mp
    return [float(mean), float(variance), [float(v / variance) for v in first], [float(v / variance) for v in total]]


def borehole(order):
    def flow(rw, r, tu, hu, tl, hl, length, kw):
        g = np.log(r / rw)
        return 2 * np.pi * tu * (hu - hl) / (g * (1 + 2 * length * tu / (g * rw**2 * kw) + tu / tl))

    x, w = np.polynomial.hermite_e.hermegauss(order)
    rules = [
        normal(0.1, 0.0161812, 0.05, 0.15, 2 * order),
        (np.exp(7.71 + 1.0056 * x), w / w.sum()),
        rule(63070, 115600, order // 2),
        rule(990, 1110, 2),
        rule(63.1, 116, order // 2),
        rule(700, 820, 2),
        rule(1120, 1680, order),
        rule(9855, 12045, order // 2),
    ]
    return tensor(flow, rules)


def otl_circuit(order):
    def voltage(rb1, rb2, rf, rc1, rc2, beta):
        vb1 = 12 * rb2 / (rb1 + rb2)
        c = beta * (rc2 + 9)
        return (vb1 + 0.74) * c / (c + rf) + 11.35 * rf / (c + rf) + 0.74 * rf * c / ((c + rf) * rc1)

    boxes = [(50, 150), (25, 70), (0.5, 3), (1.2, 2.5), (0.25, 1.2), (50, 300)]
    return tensor(voltage, [rule(a, b, order) for a, b in boxes])


def piston(order):
    def time(m, s, v0, k, p0, ta, t0):
        a = p0 * s + 19.62 * m - k * v0 / s
        v = s / (2 * k) * (np.sqrt(a * a + 4 * k * p0 * v0 * ta / t0) - a)
        return 2 * np.pi * np.sqrt(m / (k + s * s * p0 * v0 * ta / (t0 * v * v)))

    boxes = [(30, 60), (0.005, 0.02), (0.002, 0.01), (1000, 5000), (90000, 110000), (290, 296), (340, 360)]
    orders = [order, 2 * order, 2 * order, order, order // 2, 3, 4]
    return tensor(time, [rule(a, b, n) for (a, b), n in zip(boxes, orders)])


def flat(answer):
    mean, variance, first, total = answer
    return np.array([mean, variance, *first, *total])


cases = []
for function, coarse, fine in [
    (flood, 20, 30),
    (borehole, 8, 10),
    (wing_weight, 20, 30),
    (otl_circuit, 10, 12),
    (piston, 8, 10),
]:
    answer, check = function(fine), function(coarse)
    mean, variance, first, total = answer
    error = np.abs(flat(answer) - flat(check))
    relative = max(error[0] / abs(mean), error[1] / variance, error[2:].max())
    cases.append(
        dict(
            function=function.__name__.replace("_", "-"),
            mean=mean,
            variance=variance,
            first_order=first,
            total=total,
            error=float(f"{relative:.1e}"),
        )
    )
target = pathlib.Path(__file__).with_name("known-reference.json")
target.write_text("[\n" + ",\n".join(json.dumps(case) for case in cases) + "\n]\n")
