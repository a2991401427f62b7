"""The slip of the particle by independent integration, frozen in afm_slip.json.

`ramps`: LuGre friction without inertia, exact geometry, the load falling with the twist. Unknowns: the twist theta and
the force d on the dashpots; sigma0 z = F_Y(theta) - d. The substrate moves at V, the apex at V - v, so
theta' = (V - v)/(ds/dtheta), d' = F_Y'(theta) theta' - sigma0 z', with v from d = sigma1 z' + sigma2 v. Radau, rtol 1e-11
for the twist, until V - v, to which dF/dt is proportional, has fallen below 1e-9 of V or changed its sign:
the largest force. Then once more until 99.9 % of it: the critical time.
`swings`: the equations of motion of the tip with its inertia, the apex at V t (four unknowns, as printed by Tafazzoli &
Sitti 2004 with the signs of the library's documentation), DOP853, rtol 1e-12, until F_Y first reaches F_Y*(F_Z): Coulomb
and Hurtado-Kim friction on a JKR contact.

Run: python3 afm_slip.py > afm_slip.json   (needs numpy and scipy)
"""
import json
from math import asin, cos, expm1, log10, pi, radians, sin, sqrt
from multiprocessing import Pool

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

NAMES = ["length", "width", "thickness", "height", "velocity", "elastic_modulus", "equivalent_modulus", "adhesion"]
LOW = [200e-6, 5e-6, 0.25e-6, 5e-6, 0.0, 120e9, 10e9, 0.0]
HIGH = [700e-6, 80e-6, 2.5e-6, 20e-6, 800e-9, 200e9, 100e9, 3.0]
NOMINAL = [225e-6, 48e-6, 1e-6, 12e-6, 100e-9, 169e9, 60e9, 0.2]


class Scene:
    def __init__(self, factors, sigma2=1e-7):
        length, width, thick, self.H, self.V, modulus, self.K, self.adhesion = factors
        self.Kz = modulus * width * thick**3 / (4 * length**3)
        self.Ky = modulus * thick * width**3 / (4 * length**3)
        self.Kt = modulus / (2 * 1.27) * width * thick**3 / (3 * length)
        self.klat = 1 / (1 / self.Ky + self.H**2 / self.Kt)
        self.z0 = length * sin(radians(0.7))
        self.sigma2 = sigma2
        self.Rp, self.mu_s, self.mu_d, self.tau = 50e-9, 0.8, 0.7, 28e6
        self.sigma0, self.sigma1, self.vs = 625.0, 1.6e-7, 1e-3
        r = 3e-6
        self.m = 2330 * pi * r * r * self.H / 3
        i_c = self.m * (3 / 80) * (4 * r * r + self.H**2)
        self.Ip = i_c - self.m * self.H**2 / 4

    def FZ(self, th):
        return self.Kz * (self.z0 - 2 * self.H * sin(th / 2) ** 2)

    def FY(self, th):
        return (self.Kt * th / self.H - self.FZ(th) * sin(th)) / cos(th)

    def dFY(self, th):
        s, c = sin(th), cos(th)
        moment = self.Kt / self.H - self.FZ(th) * c + self.Kz * self.H * s * s
        return moment / c + self.FY(th) * s / c

    def travel(self, th):
        return self.H * sin(th) + self.FY(th) / self.Ky

    def radius(self, force):
        """JKR."""
        pull = 3 * pi * self.adhesion * self.Rp
        return (self.Rp / self.K * (force + pull + sqrt(2 * pull * force + pull * pull))) ** (1 / 3)

    def hold(self, law, force):
        a = self.radius(force)
        if law == "coulomb":
            return self.mu_s * force + self.tau * pi * a * a
        g, b = 2 * 27e9 * 31.2e9 / (27e9 + 31.2e9), 0.288e-9
        t1, t2, a1, a2 = 1 / 43, 1 / 1290, 28.0, 8e4
        ratio = a / b
        if ratio < a1:
            shear = t1
        elif ratio > a2:
            shear = t2
        else:
            shear = 10 ** (log10(t1) + (log10(t2) - log10(t1)) * log10(ratio / a1) / log10(a2 / a1))
        return pi * a * a * g * shear


def ramp(scene):
    """F_Y, F_Z and travel of the apex at the largest force, and the time at 99.9 % of it; None where the load is gone before."""
    c, V = scene, scene.V

    def stribeck(v, load):
        return load * (c.mu_s + (c.mu_s - c.mu_d) * expm1(-((v / c.vs) ** 2)))

    last = 2 * asin(sqrt(c.z0 / c.H / 2)) if c.z0 < 2 * c.H and c.z0 < c.H else pi / 2
    unit = c.mu_s * c.Kz * c.z0 + c.sigma2 * V
    dash = (c.sigma1 + c.sigma2) * V
    time = unit / (c.klat * V)
    turn = unit * c.H / c.Kt

    def velocity(th, d):
        load = c.FZ(th)
        v = V
        for _ in range(60):
            strength = stribeck(v, load)
            new = d / (c.sigma1 * (1 - (c.FY(th) - d) / strength) + c.sigma2)
            if abs(new - v) <= 1e-16 * abs(new):
                break
            v = new
        return new, strength

    # d' holds sigma0 v (1 - sigma0 z/Fss), in which the rounding of sigma0 z shows by `noise` of d. A relative tolerance
    # of 1e-11 of d + shift is that much of d.
    noise = min(max(1e-16 * c.sigma0 * V * time / dash, 1e-11), 1e-7)
    shift = noise / 1e-11

    def rate(_, y):
        th, d = y[0] * turn, (y[1] - shift) * dash
        v, strength = velocity(th, d)
        spin = (V - v) / (c.H * cos(th) + c.dFY(th) / c.Ky)
        bristles = c.sigma0 * (v - v * (c.FY(th) - d) / strength)
        return [spin * time / turn, (c.dFY(th) * spin - bristles) * time / dash]

    def still(_, y):
        return velocity(y[0] * turn, (y[1] - shift) * dash)[0] / V - 1 + 1e-9

    def lifted(_, y):
        return y[0] * turn - last * (1 - 1e-9)

    still.terminal = lifted.terminal = True
    horizon = 60 * (2 + c.sigma2 * V / unit + unit / (c.sigma0 * V * time))

    def march(events):
        return solve_ivp(rate, (0, horizon), [0.0, shift], method="Radau", rtol=1e-11, atol=1e-13, events=events,
                         first_step=1e-12)

    out = march([still, lifted])
    if len(out.t_events[1]) > 0:
        return None
    assert len(out.t_events[0]) > 0, (out.status, out.message, scene.__dict__)
    th = out.y[0, -1] * turn
    # The rise may have been passed between two steps: the largest of them.
    th = max(th, max(out.y[0]) * turn)

    def slips(_, y):
        return c.FY(y[0] * turn) / (0.999 * c.FY(th)) - 1

    slips.terminal = True
    slipped = march([slips]).t_events[0][0] * time
    return dict(lateral_force=c.FY(th), normal_force=c.FZ(th), travel=c.travel(th), critical_time=slipped,
                steps=len(out.t))


def swing(scene, law):
    """The first slip of the tip that swings."""
    c, V = scene, scene.V

    def quasi_static(th):
        return c.FY(th) - c.hold(law, c.FZ(th))

    th0 = brentq(quasi_static, 0, 1.0 if c.z0 > c.H else min(1.0, 2 * asin(sqrt(c.z0 / c.H / 2))), xtol=1e-18, rtol=1e-14)
    time = c.travel(th0) / V
    It = c.Ip + c.m * c.H**2 / 2

    def accelerations(y):
        th, w, yp, _ = y
        zp = c.z0 - 2 * c.H * sin(th / 2) ** 2
        turn = (c.H * (c.Ky * yp * cos(th) + c.Kz * zp * sin(th)) - c.Kt * th) / It
        return turn, zp

    def rate(_, z):
        y = z * scale
        turn, _ = accelerations(y)
        th, w = y[0], y[1]
        return np.array([w, turn, y[3], -c.H * turn * cos(th) + c.H * w * w * sin(th)]) / scale * unit

    def forces(z):
        y = z * scale
        th, w, yp, _ = y
        turn, zp = accelerations(y)
        fz = (c.Ip * turn + c.Kt * th) / c.H * sin(th) + c.Kz * zp * cos(th) ** 2 - c.Ky * yp * sin(th) * cos(th) \
            - c.m * cos(th) * (c.H / 2) * w * w
        return c.Ky * yp + c.m * (c.H / 2) * (-turn * cos(th) + w * w * sin(th)), fz

    def slips(_, z):
        fy, fz = forces(z)
        return fy / c.hold(law, fz) - 1

    omega = sqrt((c.Kt + c.Ky * c.H**2) / It)
    unit = 1 / omega
    scale = np.array([V / c.H / omega, V / c.H, V / omega, V])
    slips.terminal, slips.direction = True, 1
    out = solve_ivp(rate, (0, 2 * time * omega), np.array([0.0, 1.0, 0.0, 0.0]), method="DOP853", rtol=1e-12, atol=1e-12,
                    events=slips, max_step=0.3)
    assert len(out.t_events[0]) == 1
    fy, fz = forces(out.y_events[0][0])
    return dict(lateral_force=fy, normal_force=fz, critical_time=out.t_events[0][0] / omega, turns=float(omega * time / 2 / pi))


def corners(velocity):
    """The corners of length, width, thickness, height and modulus; contact modulus and adhesion at opposite ends."""
    for bits in range(32):
        ends = [bits >> i & 1 for i in range(5)]
        length, width, thick, height, modulus = [(LOW if not e else HIGH)[i] for e, i in zip(ends, [0, 1, 2, 3, 5])]
        yield [length, width, thick, height, velocity, modulus, *((10e9, 3.0) if ends[0] else (100e9, 0.0))]


def plain(case):
    return {key: value if isinstance(value, (str, list, int)) else float(value) for key, value in case.items()}


def ramp_case(case):
    factors, sigma2 = case
    found = ramp(Scene(factors, sigma2))
    return plain(dict(factors=factors, sigma2=sigma2) | (found or dict(lifted=1)))


def swing_case(case):
    factors, law = case
    return plain(dict(factors=factors, law=law) | swing(Scene(factors), law))


def cases():
    random = np.random.default_rng(12)

    def box(count):
        return [[lo + u * (hi - lo) for lo, hi, u in zip(LOW, HIGH, us)] for us in random.random((count, 8))]

    def swinging(factors, law, turns):
        """At the velocity, some 0.1 mm/s and more, at which the tip swings so many times before the slip."""
        scene = Scene([*factors[:4], 1.0, *factors[5:]])
        omega = sqrt((scene.Kt + scene.Ky * scene.H**2) / (scene.Ip + scene.m * scene.H**2 / 2))
        travel = scene.hold(law, scene.Kz * scene.z0) / scene.klat
        return [*factors[:4], float(travel * omega / 2 / pi / turns), *factors[5:]], law

    at_box = [NOMINAL, *box(12), *list(corners(800e-9))[::2], *list(corners(800e-9))[1::6], *list(corners(1e-9))[::11]]
    ramps = [(factors, sigma2) for factors in at_box for sigma2 in [1e-7, 0.3]]
    quick = [(NOMINAL, 300), (NOMINAL, 30), *zip(box(10), np.geomspace(5, 300, 10))]
    swings = [swinging(factors, law, turns) for factors, turns in quick for law in ["coulomb", "hk"]]
    return ramps, swings


def main():
    ramps, swings = cases()
    with Pool() as pool:
        print(json.dumps(dict(names=NAMES, ramps=pool.map(ramp_case, ramps, 1), swings=pool.map(swing_case, swings, 1)), indent=0))


if __name__ == "__main__":
    main()
