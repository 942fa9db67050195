"""Reference distances between two links, to 30 digits: tests/data/link_link.jsonl.

    pip install mpmath
    python3 crates/studies/reference/link_link.py > tests/data/link_link.jsonl

The program knows nothing of the library's case split. It lists what a link's surface is made of (axis and round ends,
swollen by the radius; faces and rims of flat caps), solves for the places where the features of one link are nearest to
those of the other, in 60 digits, and keeps an answer only with a proof of it: the two points are in their links, and the
plane across the way between them separates the links by as much as the points are apart, to 1e-34. A distance of 0 is
proven by a common point. A pair without a proof is named, and another is drawn.
"""

import json
import math
import random
import struct
import sys

from mpmath import mp, mpf

mp.dps = 60
TINY = mpf(10) ** -34


def add(a, b): return [x + y for x, y in zip(a, b)]
def sub(a, b): return [x - y for x, y in zip(a, b)]
def mul(a, k): return [x * k for x in a]
def dot(a, b): return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
def cross(a, b): return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
def sqrt(x): return mp.sqrt(x) if isinstance(x, mpf) else math.sqrt(x)
def norm(a): return sqrt(dot(a, a))
def unit(a): return mul(a, 1 / norm(a))
def across(v, axis): return sub(v, mul(axis, dot(v, axis)))


def basis(axis):
    least = min(range(3), key=lambda i: abs(axis[i]))
    u = unit(across([axis[0] * 0 + (i == least) for i in range(3)], axis))
    return u, cross(axis, u)


class Link:
    def __init__(self, p0, p1, r, flat, number=mpf):
        self.ends = [[number(x) for x in p0], [number(x) for x in p1]]
        self.r = number(r)
        way = sub(self.ends[1], self.ends[0])
        self.length = norm(way)
        self.axis = mul(way, 1 / self.length) if self.length else None
        self.flat = flat if self.length else [False, False]
        self.basis = basis(self.axis) if self.length else None
        if self.length:
            self.float_basis = [[float(x) for x in v] for v in self.basis]

    def outward(self, end):
        return self.axis if end else mul(self.axis, -1)

    def support(self, n):
        """The largest n . x of the link, for a unit vector n."""
        best = None
        for end in (0, 1):
            lean = dot(n, self.outward(end)) if self.axis else mpf(0)
            is_ball = not self.flat[end] and lean >= 0
            share = mpf(1) if is_ball or not self.axis else norm(across(n, self.axis))
            here = dot(n, self.ends[end]) + self.r * share
            best = here if best is None or here > best else best
        return best

    def beyond(self, x):
        """How far x is from the link."""
        if not self.axis:
            return max(norm(sub(x, self.ends[0])) - self.r, mpf(0))
        along = dot(sub(x, self.ends[0]), self.axis)
        for end, past in ((0, -along), (1, along - self.length)):
            if past > 0:
                way = sub(x, self.ends[end])
                if not self.flat[end]:
                    return max(norm(way) - self.r, mpf(0))
                rho = norm(across(way, self.axis))
                return sqrt(past ** 2 + max(rho - self.r, mpf(0)) ** 2)
        return max(norm(across(sub(x, self.ends[0]), self.axis)) - self.r, mpf(0))

    def nearest(self, x):
        """Its point nearest to x."""
        if not self.axis:
            way = sub(x, self.ends[0])
            reach = norm(way)
            return x if reach <= self.r else add(self.ends[0], mul(way, self.r / reach))
        along = dot(sub(x, self.ends[0]), self.axis)
        end = 0 if along < 0 else 1 if along > self.length else None
        foot = add(self.ends[0], mul(self.axis, min(max(along, along * 0), self.length)))
        way = sub(x, foot)
        if end is not None and self.flat[end]:
            way = across(way, self.axis)
        reach = norm(way)
        if reach > self.r:
            way = mul(way, self.r / reach)
        return add(foot, way)

    def features(self):
        """(kind, end, how far it is swollen)"""
        if self.axis:
            yield ("line", 0, self.r)
        for end in (0, 1):
            if self.flat[end]:
                yield ("face", end, mpf(0))
                yield ("rim", end, mpf(0))
            else:
                yield ("point", end, self.r)

    def rim(self, end, angle):
        u, v = self.basis
        return add(self.ends[end], mul(add(mul(u, mp.cos(angle)), mul(v, mp.sin(angle))), self.r))

    def float_rim(self, end, angle):
        u, v = self.float_basis
        c, r = [float(x) for x in self.ends[end]], float(self.r)
        return add(c, mul(add(mul(u, math.cos(angle)), mul(v, math.sin(angle))), r))

    def tangent(self, angle):
        """First and second derivative of a rim by its angle."""
        u, v = self.basis
        first = mul(add(mul(u, -mp.sin(angle)), mul(v, mp.cos(angle))), self.r)
        second = mul(add(mul(u, mp.cos(angle)), mul(v, mp.sin(angle))), -self.r)
        return first, second


def rim_to_point(link, end, x):
    way = across(sub(x, link.ends[end]), link.axis)
    reach = norm(way)
    if reach == 0:
        return link.rim(end, mpf(0))
    return add(link.ends[end], mul(way, link.r / reach))


# Whether a second look is taken for minima that lie close together: of rims that are nearly tangent.
closer = False


def scan(distance, starts=96):
    """The angles near which a function has a local minimum."""
    for angle in minima(distance, starts):
        yield angle
        if closer:
            for power in range(1, 9):
                yield angle + 10.0 ** -power
                yield angle - 10.0 ** -power
                yield angle + 3 * 10.0 ** -power
                yield angle - 3 * 10.0 ** -power


def minima(distance, starts):
    values = [distance(2 * math.pi * k / starts) for k in range(starts)]
    for k in range(starts):
        if values[k] <= values[k - 1] and values[k] <= values[(k + 1) % starts]:
            low, high = 2 * math.pi * (k - 1) / starts, 2 * math.pi * (k + 1) / starts
            for _ in range(40):
                a, b = low + (high - low) * 0.382, low + (high - low) * 0.618
                low, high = (low, b) if distance(a) < distance(b) else (a, high)
            yield 0.5 * (low + high)


def solve(first, f, second, g):
    """Pairs of points of the two features where one is nearest to the other."""
    (kind1, end1, _), (kind2, end2, _) = f, g
    order = ["point", "line", "face", "rim"]
    if order.index(kind1) > order.index(kind2):
        for y, x in solve(second, g, first, f):
            yield x, y
        return
    kinds = (kind1, kind2)
    c1, c2 = first.ends[end1], second.ends[end2]
    if kinds == ("point", "point"):
        yield c1, c2
    elif kinds == ("point", "line"):
        yield c1, add(c2, mul(second.axis, dot(sub(c1, c2), second.axis)))
    elif kinds == ("point", "face"):
        yield c1, add(c2, across(sub(c1, c2), second.axis))
    elif kinds == ("point", "rim"):
        yield c1, rim_to_point(second, end2, c1)
    elif kinds == ("line", "line"):
        n = cross(first.axis, second.axis)
        square = dot(n, n)
        if square > mpf(10) ** -50:
            w = sub(c2, c1)
            s = dot(cross(w, second.axis), n) / square
            t = dot(cross(w, first.axis), n) / square
            yield add(c1, mul(first.axis, s)), add(c2, mul(second.axis, t))
        else:
            places = sorted([mpf(0), first.length] + [dot(sub(e, c1), first.axis) for e in second.ends])
            x = add(c1, mul(first.axis, (places[1] + places[2]) / 2))
            yield x, add(c2, mul(second.axis, dot(sub(x, c2), second.axis)))
    elif kinds == ("line", "face"):
        # What is nearest is at an end or at the rim, or the line meets the face.
        slope = dot(first.axis, second.axis)
        if abs(slope) > mpf(10) ** -50:
            x = add(c1, mul(first.axis, dot(sub(c2, c1), second.axis) / slope))
            yield x, x
    elif kinds == ("line", "rim"):
        axis, start = [float(x) for x in first.axis], [float(x) for x in c1]
        def off(angle):
            return norm(across(sub(second.float_rim(end2, angle), start), axis))
        for angle in scan(off):
            angle = mpf(angle)
            for _ in range(12):
                way = across(sub(second.rim(end2, angle), c1), first.axis)
                one, two = second.tangent(angle)
                flat_one = across(one, first.axis)
                slope, curve = dot(way, one), dot(flat_one, flat_one) + dot(way, two)
                if curve == 0:
                    break
                angle -= slope / curve
            y = second.rim(end2, angle)
            yield add(c1, mul(first.axis, dot(sub(y, c1), first.axis))), y
    elif kinds == ("face", "face"):
        x = c1
        for _ in range(3):
            way = across(sub(c2, c1), first.axis)
            reach = norm(way)
            x = add(c1, mul(way, min(first.r / reach, mpf(1)) if reach else mpf(0)))
            way = across(sub(x, c2), second.axis)
            reach = norm(way)
            yield x, add(c2, mul(way, min(second.r / reach, mpf(1)) if reach else mpf(0)))
    elif kinds == ("face", "rim"):
        lean = across(first.axis, second.axis)
        reach = norm(lean)
        if reach > mpf(10) ** -50:
            for sign in (1, -1):
                y = add(c2, mul(lean, sign * second.r / reach))
                yield sub(y, mul(first.axis, dot(sub(y, c1), first.axis))), y
    elif kinds == ("rim", "rim"):
        centre, axis = [float(x) for x in c2], [float(x) for x in second.axis]
        def onto(x):
            way = across(sub(x, centre), axis)
            reach = norm(way)
            return add(centre, mul(way, float(second.r) / reach)) if reach else second.float_rim(end2, 0.0)
        def off(angle):
            x = first.float_rim(end1, angle)
            return norm(sub(x, onto(x)))
        for angle in scan(off):
            y = sub(onto(first.float_rim(end1, angle)), centre)
            u, v = second.float_basis
            a, b = mpf(angle), mpf(math.atan2(dot(y, v), dot(y, u)))
            for _ in range(40):
                way = sub(second.rim(end2, b), first.rim(end1, a))
                (x1, x2), (y1, y2) = first.tangent(a), second.tangent(b)
                ga, gb = -dot(way, x1), dot(way, y1)
                haa, hbb, hab = dot(x1, x1) - dot(way, x2), dot(y1, y1) + dot(way, y2), -dot(x1, y1)
                det = haa * hbb - hab * hab
                if abs(det) < mpf(10) ** -55:
                    break
                da, db = (hbb * ga - hab * gb) / det, (haa * gb - hab * ga) / det
                a, b = a - da, b - db
                if abs(da) + abs(db) < mpf(10) ** -50:
                    break
            yield first.rim(end1, a), second.rim(end2, b)


def common(first, second, hint):
    """A point of both links."""
    start = hint or mul(add(add(*first.ends), add(*second.ends)), mpf(1) / 4)
    for x in (start, first.nearest(start), second.nearest(start)):
        if first.beyond(x) <= TINY and second.beyond(x) <= TINY:
            return x
    # By turns the nearest points of either; of a deep overlap a point inside both is met soon.
    for x in (start, first.ends[0], first.ends[1], second.ends[0], second.ends[1]):
        for _ in range(60):
            y = first.nearest(x)
            z = second.nearest(y)
            # Beyond the point, lest the way ends at the surface.
            x = add(z, mul(sub(z, y), mpf(1) / 2))
            for p in (y, z, x):
                if first.beyond(p) <= TINY and second.beyond(p) <= TINY:
                    return p
    return None


def common_of_shallow(first, second):
    """A point of both: where the rims meet the other's faces, or between what features are nearest."""
    points = list(crossings(first, second)) + list(crossings(second, first))
    for f in first.features():
        for g in second.features():
            points += [mul(add(x, y), mpf(1) / 2) for x, y in solve(first, f, second, g)]
    for p in points:
        if first.beyond(p) <= TINY and second.beyond(p) <= TINY:
            return p
    return None


def crossings(first, second):
    """Where the rims of one link are in the planes of the other's faces, and halfway between."""
    for end1 in (0, 1):
        for end2 in (0, 1):
            if not first.flat[end1] or not second.flat[end2]:
                continue
            u, v = first.basis
            a, b = dot(u, second.axis) * first.r, dot(v, second.axis) * first.r
            c = dot(sub(second.ends[end2], first.ends[end1]), second.axis)
            reach = sqrt(a * a + b * b)
            if reach > abs(c):
                middle, half = mp.atan2(b, a), mp.acos(c / reach)
                x, y = (first.rim(end1, middle + half * sign) for sign in (1, -1))
                z = mul(add(x, y), mpf(1) / 2)
                yield from (x, y, z, mul(add(x, z), mpf(1) / 2), mul(add(y, z), mpf(1) / 2))


def distance(first, second, hint=None):
    """The distance, and the two points, proven."""
    scale = max([abs(x) for link in (first, second) for end in link.ends for x in end] + [first.r, second.r])
    point = common(first, second, hint)
    if point is not None:
        return mpf(0), point, point
    global closer
    for closer in (False, True):
        found = nearest_features(first, second, scale)
        if not found and (point := common_of_shallow(first, second)) is not None:
            found = mpf(0), point, point
        if found:
            closer = False
            return found
    closer = False
    return None


def nearest_features(first, second, scale):
    """The distance between two features that comes with a proof."""
    # Those that take long come last.
    pairs = sorted(((f, g) for f in first.features() for g in second.features()),
                   key=lambda pair: sum(kind == "rim" for kind, _, _ in pair))
    for f, g in pairs:
        for x, y in solve(first, f, second, g):
            way = sub(y, x)
            reach = norm(way)
            if reach - f[2] - g[2] <= 0:
                continue
            n = mul(way, 1 / reach)
            x, y = add(x, mul(n, f[2])), sub(y, mul(n, g[2]))
            if first.beyond(x) > TINY * scale or second.beyond(y) > TINY * scale:
                continue
            upper = norm(sub(y, x))
            lower = -second.support(mul(n, -1)) - first.support(n)
            if upper - lower <= TINY * scale:
                return upper, x, y
    return None


def f32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


rng = random.Random(37)


def direction():
    while True:
        v = [rng.gauss(0, 1) for _ in range(3)]
        if norm(v) > 0.1:
            return unit(v)


def rotation():
    while True:
        q = [rng.gauss(0, 1) for _ in range(4)]
        s = math.sqrt(sum(x * x for x in q))
        if s > 0.1:
            w, x, y, z = (c / s for c in q)
            return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                    [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                    [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]]


def caps():
    return [rng.random() < 0.6, rng.random() < 0.6]


def length():
    return 10 ** rng.uniform(-1, 0.7)


def tiny():
    return rng.choice([0.0, 0.0, 10 ** rng.uniform(-16, -3)])


def pick(family):
    """Two links as (p0, p1, r, flat)."""
    a0 = [0.0, 0.0, 0.0]
    a1 = [0.0, 0.0, rng.choice([1.0, 2.0, 0.25])]
    r1, r2 = rng.choice([0.5, 1.0, 10 ** rng.uniform(-2, 0.3)]), rng.choice([0.5, 1.0, 10 ** rng.uniform(-2, 0.3)])
    l2 = rng.choice([1.0, 0.5, length()])
    f1, f2 = caps(), caps()
    aligned = lambda b0, d: ((a0, a1, r1, f1), (b0, add(b0, mul(d, l2)), r2, f2))
    if family == "generic":
        b0 = mul(direction(), rng.uniform(0, 3))
        return aligned(b0, direction())
    if family == "parallel":
        d = rng.choice([1.0, -1.0])
        b0 = [rng.choice([0.25, 1.5, 2.0, rng.uniform(0, 4)]), 0.0, rng.choice([-1.0, 0.0, 1.0, 2.0, rng.uniform(-3, 3)])]
        return aligned(b0, unit([tiny(), tiny(), d]))
    if family == "coaxial":
        gap = rng.choice([0.0, 0.5, 10 ** rng.uniform(-12, 0)])
        b0 = [tiny(), 0.0, a1[2] + gap]
        return aligned(b0, unit([tiny(), tiny(), 1.0]))
    if family == "coplanar":
        d = [math.cos(t := rng.uniform(0, 6.3)), 0.0, math.sin(t)]
        b0 = [rng.uniform(-3, 3), tiny(), rng.uniform(-3, 3)]
        return aligned(b0, d)
    if family == "edge on":
        b0 = [rng.choice([0.0, 0.5, 1.0, rng.uniform(0, 3)]), rng.choice([0.0, 1.0]), a1[2] + rng.choice([0.0, r2, 1.0, 0.1])]
        return aligned(b0, unit([rng.choice([1.0, -1.0]), tiny(), tiny()]))
    if family == "faces":
        # Nearly parallel faces, one over the other or beside it.
        f1[1], f2[0] = True, True
        t = rng.uniform(0, 6.3)
        off = rng.choice([0.0, r1, r1 + r2, abs(r1 - r2), rng.uniform(0, 3)])
        b0 = [off * math.cos(t), off * math.sin(t), a1[2] + rng.choice([0.0, 0.5, 10 ** rng.uniform(-9, 0)])]
        return aligned(b0, unit([tiny(), tiny(), 1.0]))
    if family == "crossing discs":
        f1[1], f2[0] = True, True
        d = direction()
        x = mul([math.cos(t := rng.uniform(0, 6.3)), math.sin(t), 0.0], r1 * rng.choice([0.5, 0.99, 1.0, rng.uniform(0, 1.5)]))
        y = mul(unit(across(direction(), d)), r2 * rng.choice([0.5, 0.99, 1.0, rng.uniform(0, 1.5)]))
        return aligned(sub(add(a1, x), y), d)
    if family == "rims":
        f1, f2 = [True, True], [True, True]
        l2 = 10 ** rng.uniform(-2, 0)
        b0 = mul(direction(), (r1 + r2) * rng.uniform(0.6, 1.6))
        return (a0, [0.0, 0.0, 10 ** rng.uniform(-2, 0)], r1, f1), (b0, add(b0, mul(direction(), l2)), r2, f2)
    if family == "wires":
        r1, r2 = rng.choice([(0.0, r2), (r1, 0.0), (0.0, 0.0)])
        b0 = mul(direction(), rng.uniform(0, 2))
        return aligned(b0, direction())
    if family == "balls":
        b0 = mul(direction(), rng.uniform(0, 3))
        ball = (b0, b0, r2, [False, False])
        other = (a0, a0, r1, [False, False]) if rng.random() < 0.2 else (a0, a1, r1, f1)
        return (other, ball) if rng.random() < 0.5 else (ball, other)
    if family == "sizes":
        k = 10 ** rng.uniform(-5, -1)
        b0 = mul(direction(), rng.uniform(0, 3))
        return (a0, a1, r1, f1), (b0, add(b0, mul(direction(), l2 * k)), r2 * k, f2)
    raise ValueError(family)


FAMILIES = [("generic", 200), ("parallel", 200), ("coaxial", 150), ("coplanar", 150), ("edge on", 150), ("faces", 150),
            ("crossing discs", 200), ("rims", 250), ("wires", 100), ("balls", 100), ("sizes", 100)]
# From these, pairs moved together until they touch but for a gap, or overlap by it.
NEAR = 250


def moved(pair):
    """Both links by one motion, in f64, with coordinates in f32 for some."""
    turn = rotation() if rng.random() < 0.5 else [[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]]
    shift = [0.0] * 3 if rng.random() < 0.6 else mul(direction(), 10 ** rng.uniform(-1, 3))
    single = rng.random() < 0.5
    place = lambda p: [(f32(x) if single else x) for x in add([dot(row, p) for row in turn], shift)]
    links = [(place(p0), place(p1), f32(r) if single else r, flat) for p0, p1, r, flat in pair]
    return links


def write(number, family, links, hint=None):
    first, second = (Link(*link) for link in links)
    for link, data in zip((first, second), links):
        data[3][:] = link.flat
    found = distance(first, second, hint)
    if found is None:
        print(f"no proof, so another is drawn: {family} {links}", file=sys.stderr)
        return None
    d, x, y = found
    numbers = [c for p0, p1, r, _ in links for c in p0 + p1]
    corners = [p for p0, p1, _, _ in links for p in (p0, p1)]
    extent = max(max(max(p[i] for p in corners) - min(p[i] for p in corners) for i in range(3)), links[0][2], links[1][2])
    is_single = all(f32(c) == c for c in numbers + [links[0][2], links[1][2]])
    print(json.dumps({
        "id": f"k{number:05}", "cat": family, "links": [[p0, p1] for p0, p1, _, _ in links],
        "radii": [r for _, _, r, _ in links], "flat": [f for _, _, _, f in links],
        "d": mp.nstr(d, 30), "scale": extent, "mag": max(abs(c) for c in numbers), "f32": is_single}, separators=(",", ":")))
    return d, x, y


def main():
    number, kept = 0, []
    for family, count in FAMILIES:
        until = number + count
        while number < until:
            links = moved(pick(family))
            found = write(number, family, links)
            number += found is not None
            if found and found[0] > 0:
                kept.append((links, *found))
    rng.shuffle(kept)
    until = number + NEAR
    for links, d, x, y in kept:
        if number == until:
            break
        gap = rng.choice([1, 1, -1]) * mpf(10) ** rng.uniform(-15, -2)
        n = unit(sub(y, x))
        shift = mul(n, gap - d)
        p0, p1, r, flat = links[1]
        # Both ends by the same numbers, so that the axis keeps its direction but for rounding.
        near = lambda p: [float(c + s) for c, s in zip(p, shift)]
        other = (near(p0), near(p1), r, list(flat))
        hint = add(x, mul(n, gap / 2)) if gap < 0 else None
        number += write(number, "near", [links[0], other], hint) is not None


main()
