"""Records of a dual gantry in its loop, simulated: an absorber in the head and dry friction on three
rails, which the model in rigid.toml does not have.

    python3 records.py FOLDER [--seconds 2]

M(q) q'' + C q' + K q = F + friction, q = [X, Theta, Y, delta], with the numbers of a machine of a
master's project (van den Berg, Model-Augmentation-Public). Integrated by Moreau's midpoint rule (Moreau,
in: Nonsmooth Mechanics and Applications, 1988) at 80 kHz, in which dry friction sticks: impulses
of the rails by projected Gauss-Seidel. The controller (rigid.toml has the same) runs at the 4 kHz
of the records and sees the noise of the encoders.
"""

import argparse
import csv
import math
import random
from pathlib import Path

MB, MH, M1, M2 = 22.8, 10.1, 10.2, 10.7  # kg
MA = (1 - (150 / 157.9) ** 2) * MH  # of the head: the absorber, so that both swing at 157.9 Hz
JB, JH = 1.0, 0.05  # kg m^2
CG1, CG2, CY, CB, KB = 14.5, 20.3, 10.0, 9.0, 1987.5
LB, D, L0 = 0.725, 0.1, 0.1  # m
ARM = LB / 2
KA = MA * (2 * math.pi * 150.0) ** 2
CA = 2 * 0.05 * math.sqrt(KA * MA)
FRICTION = (16.8, 18.35, 11.6)  # N on X1, X2, Y
NOISE = (10e-9, 10e-9, 6e-9)  # m
SAMPLE, STEPS = 1 / 4000, 20
# a PID for each of X, Theta, Y: kp (1 + wi/s) (1 + s/wz) / (1 + s/wp), in discrete time
BANDWIDTH = 2 * math.pi * 100
AXES = (53.8, 3.9, 10.1)  # what each moves, kg and kg m^2
ZERO, POLE, SLOW = BANDWIDTH / 3, 3 * BANDWIDTH, BANDWIDTH / 15


class Loop:
    """The controller: from references and encoders to the forces f1, f2, fy."""

    def __init__(self):
        self.sums, self.filtered = [0.0] * 3, [0.0] * 3

    def force(self, r, y):
        e = [a - b for a, b in zip(r, y)]
        axes = ((e[0] + e[1]) / 2, (e[0] - e[1]) / LB, e[2])
        out = []
        for i, (error, mass) in enumerate(zip(axes, AXES)):
            kp, fade = mass * BANDWIDTH**2 / 3, math.exp(-POLE * SAMPLE)
            steep = (error - self.filtered[i]) * POLE / ZERO
            out.append(kp * (error + steep + SLOW * self.sums[i]))
            self.filtered[i] = fade * self.filtered[i] + (1 - fade) * error
            self.sums[i] += SAMPLE * error
        return (out[0] / 2 + out[1] / LB, out[0] / 2 - out[1] / LB, out[2])


def inverse(y, delta):
    """The inverse of M as a function of the right-hand side."""
    m11 = M1 + M2 + MB + MH
    m12 = (M1 - M2) * ARM - MH * y - MA * (L0 + delta)
    rest = MH - MA
    j = JB + JH + (M1 + M2) * ARM**2 + rest * y * y + MA * (y + L0 + delta) ** 2 - m12 * m12 / m11

    def solve(f1, f2, f3, f4):
        turn = (f2 - m12 * f1 / m11 + D * (f3 - f4) + D * f4) / j
        head = (f3 - f4) / rest + D * turn
        return ((f1 - m12 * turn) / m11, turn, head, f4 / MA + D * turn - head)

    return solve


def advance(q, v, f, h):
    """One step: q, v half a step on; forces there; impulses of the rails so that they stick or slip."""
    q = [a + 0.5 * h * b for a, b in zip(q, v)]
    solve = inverse(q[2], q[3])
    right = (
        f[0] + f[1] - (CG1 + CG2) * v[0] - (CG1 - CG2) * ARM * v[1],
        (f[0] - f[1]) * ARM - (CG1 - CG2) * ARM * v[0]
        - (2 * CB + (CG1 + CG2) * ARM**2) * v[1] - 2 * KB * q[1],
        f[2] - CY * v[2],
        -CA * v[3] - KA * q[3],
    )
    v = [a + h * b for a, b in zip(v, solve(*right))]
    rows = ((1, ARM, 0, 0), (1, -ARM, 0, 0), (0, 0, 1, 0))
    pushes = [solve(*row) for row in rows]
    speed = [sum(a * b for a, b in zip(row, v)) for row in rows]
    gains = [[sum(a * b for a, b in zip(row, push)) for push in pushes] for row in rows]
    impulse = [0.0] * 3
    for _ in range(20):
        for i in range(3):
            now = speed[i] + sum(gains[i][k] * impulse[k] for k in range(3))
            most = h * FRICTION[i]
            impulse[i] = max(-most, min(most, impulse[i] - now / gains[i][i]))
    for push, p in zip(pushes, impulse):
        v = [a + p * b for a, b in zip(v, push)]
    return [a + 0.5 * h * b for a, b in zip(q, v)], v


def smooth(t, start, long):
    """From 0 to 1 with continuous jerk."""
    s = min(max((t - start) / long, 0.0), 1.0)
    return s**4 * (35 - 84 * s + 70 * s * s - 20 * s**3)


def references(rng, seconds, scale):
    """Moves of X, Theta and Y there and back."""
    moves, t = [], 0.1
    while t < seconds - 0.3:
        long = rng.uniform(0.15, 0.3)
        moves.append((t, long, [scale * rng.uniform(-1, 1) * a for a in (0.03, 0.0005, 0.03)]))
        t += long + rng.uniform(0.02, 0.1)

    def at(t):
        x, turn, y = (sum(m[2][i] * smooth(t, m[0], m[1]) for m in moves) for i in range(3))
        return (x + ARM * turn, x - ARM * turn, y)

    return at


def multisine(rng, seconds, scale):
    """Lines from 106 to 297 Hz of random phase, on the force, the moment and the head's force."""
    lines = [k / seconds for k in range(math.ceil(106 * seconds), math.floor(297 * seconds) + 1)]
    size = [scale * rms * math.sqrt(2 / len(lines)) for rms in (240.0, 87.0, 180.0)]
    phases = [[rng.uniform(0, 2 * math.pi) for _ in lines] for _ in size]

    def at(t):
        force, moment, head = (
            a * sum(math.sin(2 * math.pi * f * t + p) for f, p in zip(lines, row))
            for a, row in zip(size, phases)
        )
        return (force / 2 + moment / LB, force / 2 - moment / LB, head)

    return at


def record(path, seed, seconds, scale):
    rng = random.Random(seed)
    reference, injected = references(rng, seconds, scale), multisine(rng, seconds, scale)
    loop, q, v = Loop(), [0.0] * 4, [0.0] * 4
    names = "time [s],r1 [m],r2 [m],ry [m],d1 [N],d2 [N],dy [N],x1 [m],x2 [m],head [m]".split(",")
    with open(path, "w", newline="") as file:
        out = csv.writer(file)
        out.writerow(names)
        for k in range(round(seconds / SAMPLE)):
            t = k * SAMPLE
            r, d = reference(t), injected(t)
            place = (q[0] + ARM * q[1], q[0] - ARM * q[1], q[2])
            y = [a + s * rng.gauss(0, 1) for a, s in zip(place, NOISE)]
            out.writerow([repr(value) for value in (t, *r, *d, *y)])
            force = [a + b for a, b in zip(loop.force(r, y), d)]
            for _ in range(STEPS):
                q, v = advance(q, v, force, SAMPLE / STEPS)


def main():
    args = argparse.ArgumentParser()
    args.add_argument("folder", type=Path)
    args.add_argument("--seconds", type=float, default=2.0)
    args = args.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    sets = (("train", 6, 1.0), ("inside", 3, 0.8), ("outside", 3, 1.3))
    for number, (name, count, scale) in enumerate(sets):
        for i in range(count):
            record(args.folder / f"{name}{i + 1}.csv", 100 * number + i, args.seconds, scale)


if __name__ == "__main__":
    main()
