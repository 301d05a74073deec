"""Derives the constants of src/core/real/elementary: `pip install mpmath`, then run.

Every polynomial is the weighted minimax fit (Remez exchange in 60 digits); its
coefficients are rounded to double one by one, lowest first, and the rest refitted
each time. Prints Rust constants and the largest error of each in bits.
"""
from mpmath import (mp, mpf, asin, atan, atanh, cos, cosh, linspace, log, lu_solve, matrix,
                    pi, sin, sinh, sqrt, floor, ldexp, frexp)

mp.dps = 60


def remez(f, weight, fixed, count, low, high):
    """Minimax c of w(z) (f(z) - sum c_i z^i), the first coefficients given."""
    start = len(fixed)
    free = count - start
    target = lambda z: f(z) - sum(c * z**i for i, c in enumerate(fixed))
    nodes = [(low + high) / 2 + (low - high) / 2 * cos(pi * (i + mpf(1) / 2) / (free + 1))
             for i in range(free + 1)]
    nodes = [z if abs(z) > (high - low) / 10**9 else (high - low) / 50 for z in nodes]
    grid = [(low + high) / 2 + (low - high) / 2 * cos(pi * i / mpf(300)) for i in range(301)]
    grid = [z for z in grid if z != 0]
    values = [target(z) for z in grid]
    weights = [weight(z) for z in grid]
    powers = [[z**(start + i) for i in range(free)] for z in grid]
    for _ in range(12):
        a = matrix(free + 1, free + 1)
        b = matrix(free + 1, 1)
        for row, z in enumerate(nodes):
            for i in range(free):
                a[row, i] = weight(z) * z**(start + i)
            a[row, free] = (-1)**row
            b[row] = weight(z) * target(z)
        c = lu_solve(a, b)
        errors = [w * (v - sum(c[i] * p[i] for i in range(free)))
                  for v, w, p in zip(values, weights, powers)]
        peaks = []
        for j, e in enumerate(errors):
            if peaks and (e > 0) == (errors[peaks[-1]] > 0):
                if abs(e) > abs(errors[peaks[-1]]):
                    peaks[-1] = j
            else:
                peaks.append(j)
        if len(peaks) < free + 1:
            break
        while len(peaks) > free + 1:
            peaks.pop(0 if abs(errors[peaks[0]]) < abs(errors[peaks[-1]]) else -1)
        new = [grid[j] for j in peaks]
        done = new == nodes
        nodes = new
        if done:
            break
    return list(fixed) + [c[i] for i in range(free)], max(abs(e) for e in errors)


def fit(name, f, weight, count, low, high):
    fixed = []
    for _ in range(count):
        c, _ = remez(f, weight, fixed, count, mpf(low), mpf(high))
        fixed.append(mpf(float(c[len(fixed)])))
    worst = max(abs(weight(z) * (f(z) - sum(c * z**i for i, c in enumerate(fixed))))
                for z in linspace(mpf(low), mpf(high), 2002)[1:] if abs(z) > mpf(10)**-9)
    print(f"// {name}: 2^{float(log(worst, 2)):.1f}")
    print("[" + ", ".join(repr(float(c)) for c in fixed) + "]")


def parts(name, value, *bits):
    """`value` as a sum of doubles of so many bits each, and a full one."""
    out = []
    for n in bits:
        if n:
            _, e = frexp(value)
            head = ldexp(floor(ldexp(value, n - e)), e - n)
        else:
            head = mpf(float(value))
        out.append(float(head))
        value -= head
    print(f"// {name}\n" + ", ".join(repr(p) for p in out))


if __name__ == "__main__":
    root = lambda g: (lambda z: g(sqrt(z)))
    s = (sqrt(mpf(2)) - 1) / (sqrt(mpf(2)) + 1)
    fit("ln: (2 atanh(s) / s - 2) / z", root(lambda s: (2 * atanh(s) / s - 2) / s**2),
        lambda z: z / 2, 7, 0, s * s)
    fit("pow: ((2 atanh(s) / s - 2) / z - 2/3) / z",
        root(lambda s: ((2 * atanh(s) / s - 2) / s**2 - mpf(2) / 3) / s**2),
        lambda z: z * z / 2, 8, 0, s * s)
    q = (pi / 4 + mpf("1e-5"))**2
    fit("sin: (sin r / r - 1) / z", root(lambda r: (sin(r) / r - 1) / r**2),
        lambda z: z, 6, 0, q)
    fit("cos: (cos r - 1 + z/2) / z^2", root(lambda r: (cos(r) - 1 + r * r / 2) / r**4),
        lambda z: z * z, 6, 0, q)
    t = (sqrt(mpf(2)) - 1)**2 + mpf("1e-6")
    fit("atan: (atan q / q - 1) / z", root(lambda q: (atan(q) / q - 1) / q**2),
        lambda z: z, 11, 0, t)
    fit("asin: (asin u / u - 1) / z", root(lambda u: (asin(u) / u - 1) / u**2),
        lambda z: z, 13, 0, mpf(1) / 4)
    h = mpf("0.34662")**2
    fit("sinh: (sinh r / r - 1) / z", root(lambda r: (sinh(r) / r - 1) / r**2),
        lambda z: z, 5, 0, h)
    fit("cosh: (cosh r - 1 - z/2) / z^2", root(lambda r: (cosh(r) - 1 - r * r / 2) / r**4),
        lambda z: z * z, 5, 0, h)
    parts("ln 2", log(mpf(2)), 42, 0)
    parts("1 / ln 2", 1 / log(mpf(2)), 0)
    parts("2/3", mpf(2) / 3, 0, 0)
    parts("pi/2 for sin, cos, tan", pi / 2, 33, 33, 33, 0)
    parts("2 / pi", 2 / pi, 0)
    parts("pi/4", pi / 4, 0, 0)
    parts("pi/2", pi / 2, 0, 0)
    parts("3 pi/4", 3 * pi / 4, 0, 0)
    parts("pi", pi, 0, 0)
    parts("tan(pi/8), tan(3 pi/8)", sqrt(mpf(2)) - 1, 0)
    print("// 2 / pi in words of 64 bits")
    mp.dps = 500
    words = int(floor(ldexp(2 / pi, 64 * 20)))
    print(", ".join(f"0x{(words >> (64 * (19 - i))) & (2**64 - 1):016x}" for i in range(20)))
