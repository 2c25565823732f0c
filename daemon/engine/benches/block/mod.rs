//! A block of C3D8 above a rigid floor, as a deck for dynamics.

use std::fmt::Write;

/// Edge of the bricks [mm].
const EDGE: f64 = 0.1;

/// A block of steel; its lower and upper half have velocities of their own, so that waves run through it.
pub struct Block {
    /// Nodes along each edge.
    pub nodes: [u32; 3],
    /// Floor below it.
    pub contact: Option<Contact>,
    /// Velocity of the lower half, upwards [mm/s].
    pub lower: f64,
    /// Velocity of the upper half [mm/s].
    pub upper: f64,
}

/// A rigid floor.
#[derive(Clone, Copy)]
pub struct Contact {
    /// How far it is below the block [mm].
    pub gap: f64,
    /// Whether the pair of face and floor stands in the model; otherwise it is left to the step.
    pub pair: bool,
}

impl Block {
    /// The deck; `step` is what stands between `*STEP` and `*END STEP`.
    pub fn deck(&self, step: &str) -> String {
        let mut text = String::from("*NODE\n");
        let [p, q, r] = self.nodes;
        let label = |i: u32, j: u32, k: u32| 1 + i + p * (j + q * k);
        for (i, j, k) in cells(self.nodes) {
            let [x, y, z] = [i, j, k].map(|n| f64::from(n) * EDGE);
            line(&mut text, format_args!("{}, {x:?}, {y:?}, {z:?}", label(i, j, k)));
        }
        text.push_str("*ELEMENT, TYPE=C3D8, ELSET=BLOCK\n");
        for (e, (i, j, k)) in (1..).zip(cells([p - 1, q - 1, r - 1])) {
            let ring = [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)];
            let [a, b, c, d] = ring.map(|(i, j)| label(i, j, k));
            let [f, g, h, l] = ring.map(|(i, j)| label(i, j, k + 1));
            line(&mut text, format_args!("{e}, {a}, {b}, {c}, {d}, {f}, {g}, {h}, {l}"));
        }
        let (middle, last) = (p * q * (r / 2), p * q * r);
        line(&mut text, format_args!("*NSET, NSET=LOWER, GENERATE\n1, {middle}, 1"));
        line(&mut text, format_args!("*NSET, NSET=UPPER, GENERATE\n{}, {last}, 1", middle + 1));
        text.push_str("*MATERIAL, NAME=STEEL\n*ELASTIC\n210000., 0.3\n*DENSITY\n7.8E-9\n");
        text.push_str("*SOLID SECTION, ELSET=BLOCK, MATERIAL=STEEL\n");
        if let Some(contact) = self.contact {
            self.floor(&mut text, contact);
        }
        let (lower, upper) = (self.lower, self.upper);
        line(&mut text, format_args!("*INITIAL CONDITIONS, TYPE=VELOCITY\nLOWER, 3, {lower:?}\nUPPER, 3, {upper:?}"));
        line(&mut text, format_args!("*STEP, INC=1000000\n{step}*END STEP"));
        text
    }

    /// One rigid facet, a little larger than the face above it, and its reference node, which is held.
    fn floor(&self, text: &mut String, contact: Contact) {
        let [p, q, r] = self.nodes;
        let first = p * q * r + 1;
        let ([x, y], z) = ([p, q].map(|n| f64::from(n) * EDGE), -contact.gap);
        text.push_str("*NODE\n");
        for (n, [x, y]) in (first..).zip([[-EDGE, -EDGE], [x, -EDGE], [x, y], [-EDGE, y], [0.0, 0.0]]) {
            line(text, format_args!("{n}, {x:?}, {y:?}, {z:?}"));
        }
        let bricks = (p - 1) * (q - 1);
        let [a, b, c, d, reference] = [0, 1, 2, 3, 4].map(|n| first + n);
        line(text, format_args!("*ELEMENT, TYPE=R3D4, ELSET=RIGID\n{}, {a}, {b}, {c}, {d}", bricks * (r - 1) + 1));
        line(text, format_args!("*ELSET, ELSET=BOTTOM, GENERATE\n1, {bricks}, 1"));
        line(text, format_args!("*RIGID BODY, ELSET=RIGID, REF NODE={reference}\n*BOUNDARY\n{reference}, 1, 6"));
        text.push_str("*SURFACE, NAME=FACE\nBOTTOM, S1\n*SURFACE, NAME=FLOOR\nRIGID, SPOS\n");
        text.push_str("*SURFACE INTERACTION, NAME=HARD\n");
        if contact.pair {
            text.push_str("*CONTACT PAIR, INTERACTION=HARD, SMALL SLIDING\nFACE, FLOOR\n");
        }
    }
}

fn line(text: &mut String, words: std::fmt::Arguments<'_>) {
    writeln!(text, "{words}").expect("text grows");
}

/// All triples below some counts, the first running fastest.
fn cells([p, q, r]: [u32; 3]) -> impl Iterator<Item = (u32, u32, u32)> {
    (0..r).flat_map(move |k| (0..q).flat_map(move |j| (0..p).map(move |i| (i, j, k))))
}
