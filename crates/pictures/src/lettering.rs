//! Lettering for the pictures: a stroke alphabet, so that it stays crisp at any size.
//!
//! A glyph is a list of strokes in units of a seventh of the height of a capital, from the base
//! line up: "L" joins the points that follow (x y), "A" is an arc of an ellipse (centre, half axes,
//! from and to in degrees).

const GLYPHS: &str = "
0 A 2 3.5 2 3.5 0 360
1 L .4 5.4 2 7 2 0
2 A 2 5 2 2 165 -35 L 3.64 3.85 0 0 4 0
3 A 1.9 5.25 1.8 1.75 150 -90 A 1.9 1.75 2.1 1.75 90 -150
4 L 3 0 3 7 0 2 4.2 2
5 L 3.7 7 .6 7 .3 3.7 A 2 2.25 2 2.25 140 -150
6 A 2 2.2 2 2.2 0 360 A 4.2 2.2 4.2 4.8 180 108
7 L 0 7 4 7 1.4 0
8 A 2 5.3 1.7 1.7 0 360 A 2 1.8 2 1.8 0 360
9 A 2 4.8 2 2.2 0 360 A -.2 4.8 4.2 4.8 0 -72
. L .1 .1 .1 .12
, L .5 .1 .1 -1.2
: L .1 .1 .1 .12 L .1 4.2 .1 4.22
; L .5 .1 .1 -1.2 L .4 4.2 .4 4.22
' L .1 7.2 .1 5.4
_ L 0 -.8 3.6 -.8
- L 0 2.7 2.4 2.7
+ L 0 2.7 3.6 2.7 L 1.8 .9 1.8 4.5
= L 0 1.9 3.6 1.9 L 0 3.6 3.6 3.6
> L 0 4.8 3.4 2.7 0 .6
< L 3.4 4.8 0 2.7 3.4 .6
/ L 0 -1 2.8 7.6
( A 3.2 3 2.8 5.4 130 230
) A -1.6 3 2.8 5.4 50 -50
% A 1 5.7 1 1.3 0 360 A 3.8 1.3 1 1.3 0 360 L 4.2 7 .6 0
* L 0 1 3.2 4.4 L 0 4.4 3.2 1
A L 0 0 2.4 7 4.8 0 L .8 2.4 4 2.4
B L 0 3.6 2.2 3.6 L 2.2 7 0 7 0 0 2.3 0 A 2.2 5.3 1.6 1.7 90 -90 A 2.3 1.8 1.9 1.8 90 -90
C A 2.6 3.5 2.6 3.5 45 315
D L 1.6 0 0 0 0 7 1.6 7 A 1.6 3.5 2.8 3.5 90 -90
E L 3.6 7 0 7 0 0 3.6 0 L 0 3.6 3 3.6
F L 3.6 7 0 7 0 0 L 0 3.6 3 3.6
G A 2.7 3.5 2.7 3.5 45 315 L 4.6 1 4.6 3.2 2.9 3.2
H L 0 0 0 7 L 4.2 0 4.2 7 L 0 3.6 4.2 3.6
I L 0 0 0 7
J L 2.6 7 2.6 1.6 A 1.2 1.6 1.4 1.6 0 -150
K L 0 0 0 7 L 4 7 0 2.6 L 1.4 4.1 4.2 0
L L 0 7 0 0 3.4 0
M L 0 0 0 7 2.6 2 5.2 7 5.2 0
N L 0 0 0 7 4.4 0 4.4 7
O A 2.7 3.5 2.7 3.5 0 360
P L 0 0 0 7 2.2 7 L 2.2 3.2 0 3.2 A 2.2 5.1 1.9 1.9 90 -90
Q A 2.7 3.5 2.7 3.5 0 360 L 3.2 1.6 5.2 -.4
R L 0 0 0 7 2.2 7 L 2.2 3.2 0 3.2 A 2.2 5.1 1.9 1.9 90 -90 L 2 3.2 4 0
S A 2.1 5.3 1.9 1.7 40 270 A 2.1 1.8 2.1 1.8 90 -140
T L 0 7 4.6 7 L 2.3 7 2.3 0
U L 0 7 0 2.2 L 4.4 2.2 4.4 7 A 2.2 2.2 2.2 2.2 180 360
V L 0 7 2.4 0 4.8 7
W L 0 7 1.7 0 3.4 6 5.1 0 6.8 7
X L 0 7 4.4 0 L 0 0 4.4 7
Y L 0 7 2.3 3.4 4.6 7 L 2.3 3.4 2.3 0
Z L 0 7 4.2 7 0 0 4.2 0
a A 1.9 2.5 1.9 2.5 0 360 L 3.8 5 3.8 0
b L 0 7.3 0 0 A 2 2.5 2 2.5 0 360
c A 2.1 2.5 2.1 2.5 50 310
d A 1.9 2.5 1.9 2.5 0 360 L 3.8 7.3 3.8 0
e L 0 2.6 4 2.6 A 2 2.5 2 2.5 3 310
f A 2.2 5.8 1.2 1.5 75 180 L 1 5.8 1 0 L 0 4.8 2.4 4.8
g A 1.9 2.5 1.9 2.5 0 360 L 3.8 5 3.8 -.4 A 1.9 -.4 1.9 1.8 0 -150
h L 0 7.3 0 0 A 1.8 3 1.8 2 180 0 L 3.6 3 3.6 0
i L 0 5 0 0 L 0 7 0 7.02
j L 1 5 1 -.8 A 0 -.8 1 1.2 0 -100 L 1 7 1 7.02
k L 0 7.3 0 0 L 3.2 5 0 1.9 L 1.2 3 3.4 0
l L 0 7.3 0 0
m L 0 5 0 0 A 1.5 3.2 1.5 1.8 180 0 L 3 3.2 3 0 A 4.5 3.2 1.5 1.8 180 0 L 6 3.2 6 0
n L 0 5 0 0 A 1.8 3 1.8 2 180 0 L 3.6 3 3.6 0
o A 2.1 2.5 2.1 2.5 0 360
p L 0 5 0 -2 A 2 2.5 2 2.5 0 360
q A 1.9 2.5 1.9 2.5 0 360 L 3.8 5 3.8 -2
r L 0 5 0 0 A 1.8 3 1.8 2 180 75
s A 1.6 3.8 1.4 1.2 45 270 A 1.6 1.3 1.6 1.3 90 -145
t L 1 6.6 1 1.4 A 2.2 1.4 1.2 1.4 180 285 L 0 4.8 2.5 4.8
u L 0 5 0 2 A 1.8 2 1.8 2 180 360 L 3.6 5 3.6 0
v L 0 5 1.8 0 3.6 5
w L 0 5 1.4 0 2.7 4.4 4 0 5.4 5
x L 0 5 3.4 0 L 0 0 3.4 5
y L 0 5 1.9 0 L 3.7 5 1.3 -1.5 .4 -2
z L 0 5 3.2 5 0 0 3.2 0
µ L 0 5 0 -2 L 0 5 0 2 A 1.8 2 1.8 2 180 360 L 3.6 5 3.6 0
";

/// A polyline.
pub type Stroke = Vec<[f32; 2]>;

/// The strokes of a line of text whose capitals have the given height, and its width: x to the
/// right from 0, y down from the base line. A character that the alphabet lacks leaves a gap.
pub fn strokes(text: &str, height: f32) -> (Vec<Stroke>, f32) {
    let unit = height / 7.0;
    let (mut all, mut x): (Vec<Stroke>, f32) = (Vec::new(), 0.0);
    for letter in text.chars() {
        let glyph = glyph(letter);
        let width = glyph.iter().flatten().map(|p| p[0]).reduce(f32::max).unwrap_or(1.3);
        all.extend(
            glyph.into_iter().map(|stroke| {
                stroke.into_iter().map(|p| [(x + p[0]) * unit, -p[1] * unit]).collect()
            }),
        );
        x += width + 1.5;
    }
    (all, (x - 1.5).max(0.0) * unit)
}

/// The strokes of one character, in the alphabet's units.
fn glyph(letter: char) -> Vec<Stroke> {
    let Some(line) = GLYPHS.lines().find(|line| line.starts_with(letter)) else {
        return Vec::new();
    };
    let mut strokes = Vec::new();
    let mut tokens = line[letter.len_utf8()..].split_whitespace().peekable();
    while let Some(kind) = tokens.next() {
        let mut numbers = Vec::new();
        while let Some(number) = tokens.peek().and_then(|token| token.parse::<f32>().ok()) {
            numbers.push(number);
            tokens.next();
        }
        strokes.push(match (kind, numbers.as_slice()) {
            ("A", &[x, y, across, up, from, to]) => (0..=24)
                .map(|step| {
                    let angle = (from + (to - from) * step as f32 / 24.0).to_radians();
                    [x + across * angle.cos(), y + up * angle.sin()]
                })
                .collect(),
            (_, points) => points.as_chunks().0.to_vec(),
        });
    }
    strokes
}
