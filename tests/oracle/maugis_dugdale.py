"""Maugis-Dugdale contacts to 60 digits, frozen in maugis_dugdale.json.

Independent of the library's way: it solves the pair of equations of Maugis 1992 as printed, the radius equation for m
at a given a by bisection, then the load equation for a by bisection above the radius of least load (golden section).
Run: python3 maugis_dugdale.py > maugis_dugdale.json   (needs mpmath)
"""
import json
from mpmath import mp, mpf, sqrt, atan, pi, cbrt, log, exp

mp.dps = 60


def zone(lam, a):
    """m of the radius equation at a; its left side rises with m."""
    def left(s):
        m = sqrt(1 + s * s)
        t = atan(s)
        return lam * a**2 / 2 * (s + (m**2 - 2) * t) + 4 * lam**2 * a / 3 * (s * t - m + 1) - 1
    low, high = mpf("1e-60"), mpf("1e60")
    for _ in range(30):
        middle = sqrt(low * high)
        low, high = (low, middle) if left(middle) > 0 else (middle, high)
    s = mp.findroot(left, (low, high), solver="anderson", tol=mpf(10) ** -100, maxsteps=300, verify=False)
    assert low <= s <= high and abs(left(s)) < mpf(10) ** -45
    return s


def load(lam, a):
    s = zone(lam, a)
    return a**3 - lam * a**2 * (s + (1 + s * s) * atan(s)), a**2 - mpf(4) / 3 * lam * a * s


def slope(lam, a):
    h = a * mpf(10) ** -20
    return (load(lam, a + h)[0] - load(lam, a - h)[0]) / (2 * h)


def bisect(function, low, high):
    """Root of a rising function between two positive ends, to 1e-30."""
    assert function(low) <= 0 <= function(high)
    low, high = log(low), log(high)
    for _ in range(12):
        middle = (low + high) / 2
        low, high = (low, middle) if function(exp(middle)) > 0 else (middle, high)
    return exp(mp.findroot(lambda x: function(exp(x)), (low, high), solver="anderson", tol=mpf(10) ** -60, maxsteps=200, verify=False))


cases = []
for lam_aim in [1e-3, 1e-2, 0.03, 0.1, 0.3, 0.5756, 1.0, 3.0, 10.0, 100.0, 1e3]:
    radius, modulus, separation = 50e-9, 60e9, 0.2e-9
    adhesion = float(lam_aim**1.5 * 0.2 / 0.5757**1.5)
    R, K, z0, w = mpf(radius), mpf(modulus), mpf(separation), mpf(adhesion)
    lam = mpf("1.157") * cbrt(16 * R * w**2 / (9 * K**2 * z0**3))
    unit, scale = pi * w * R, cbrt(pi * w * R**2 / K)
    a_min = bisect(lambda a: slope(lam, a), mpf("1e-2") * lam / (1 + lam), mpf(2))
    p_min = load(lam, a_min)[0]
    for p_aim in [float(p_min) + 1e-9, float(p_min) + 1e-4, float(p_min) + 0.01, -1.45, -1.39, -1, -0.1, 0, 1, 30, 1e3, 1e6, 1e12, 1e18]:
        force = float(p_aim * unit)
        p = mpf(force) / unit
        if p <= p_min:
            continue
        top = a_min * 2
        while load(lam, top)[0] < p:
            top *= 2
        a = bisect(lambda a: load(lam, a)[0] - p, a_min, top)
        # d ln a/d ln(P + 2) tells how far a rounding of the load moves the radius.
        condition = (abs(p) + 2) / (a * slope(lam, a))
        depth = load(lam, a)[1]
        cases.append(dict(adhesion=adhesion, load=force, radius=float(a * scale), indentation=float(depth * scale**2 / R),
                          condition=float(condition), pull_off=float(-p_min * unit), pull_off_radius=float(a_min * scale)))
print(json.dumps(dict(radius=radius, modulus=modulus, separation=separation, cases=cases), indent=0))
