//! The punch of the benchmarks as a deck: a block of n x n x n/2 bricks pressed into a larger one on a mesh that does not match.
//! Two inputs act on the top: one on a quarter of it around a corner, one on the rest. Alike they press the punch down flat; the
//! corner lifted alone opens contact points one after another.

use std::fmt::Write;

/// What acts on the top.
#[derive(Clone, Copy, Debug)]
pub enum Drive {
    /// Prescribed displacements: they hold the punch.
    Displacement,
    /// Forces on the nodes: contact alone holds the punch against them.
    Force,
}

impl Drive {
    /// The inputs on the rest of the top and on its corner.
    pub fn inputs(self) -> [&'static str; 2] {
        match self {
            Self::Displacement => ["boundary.NREST.3", "boundary.NCORNER.3"],
            Self::Force => ["cload.NREST.3", "cload.NCORNER.3"],
        }
    }

    /// Value of both by the deck: displacement [length], or force on each node.
    pub fn full(self) -> f64 {
        match self {
            Self::Displacement => -0.005,
            Self::Force => -0.2,
        }
    }

    /// The lines of the step.
    fn lines(self) -> String {
        let full = self.full();
        match self {
            Self::Displacement => format!("*BOUNDARY\nNREST, 3, 3, {full:?}\nNCORNER, 3, 3, {full:?}\n"),
            Self::Force => format!("*CLOAD\nNREST, 3, {full:?}\nNCORNER, 3, {full:?}\n"),
        }
    }
}

/// Nodes and bricks written so far.
struct Mesh {
    text: String,
    elements: String,
    nodes: u32,
    bricks: u32,
}

/// A box of bricks: node and brick labels begin after these.
struct Block {
    nodes: u32,
    bricks: u32,
    across: u32,
    layers: u32,
}

impl Mesh {
    /// A box over `across x across x layers` bricks from a lower corner, with its width and height [length].
    fn block(&mut self, part: &str, across: u32, layers: u32, from: [f64; 3], size: [f64; 2]) -> Block {
        let block = Block { nodes: self.nodes, bricks: self.bricks, across, layers };
        let at = |i: u32, count: u32, size: f64| size * f64::from(i) / f64::from(count);
        for k in 0..=layers {
            for j in 0..=across {
                for i in 0..=across {
                    self.nodes += 1;
                    let (x, y) = (from[0] + at(i, across, size[0]), from[1] + at(j, across, size[0]));
                    let z = from[2] + at(k, layers, size[1]);
                    writeln!(self.text, "{}, {x:.14}, {y:.14}, {z:.14}", self.nodes).expect("text grows");
                }
            }
        }
        writeln!(self.elements, "*ELEMENT, TYPE=C3D8, ELSET={part}").expect("text grows");
        for k in 0..layers {
            for j in 0..across {
                for i in 0..across {
                    self.bricks += 1;
                    write!(self.elements, "{}", self.bricks).expect("text grows");
                    for (a, b, c) in
                        [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
                    {
                        write!(self.elements, ", {}", block.node(i + a, j + b, k + c)).expect("text grows");
                    }
                    self.elements.push('\n');
                }
            }
        }
        block
    }
}

impl Block {
    fn node(&self, i: u32, j: u32, k: u32) -> u32 {
        let n = self.across + 1;
        self.nodes + 1 + i + n * (j + n * k)
    }

    /// Nodes of a layer that are chosen by their place in it.
    fn layer(&self, k: u32, chosen: impl Fn(u32, u32) -> bool) -> String {
        let all = (0..=self.across).flat_map(|j| (0..=self.across).map(move |i| (i, j)));
        all.filter(|&(i, j)| chosen(i, j)).map(|(i, j)| format!("{}\n", self.node(i, j, k))).collect()
    }

    /// One face of every brick of a layer.
    fn faces(&self, k: u32, face: u32) -> String {
        let first = self.bricks + 1 + self.across * self.across * k;
        (first..first + self.across * self.across).map(|brick| format!("{brick}, S{face}\n")).collect()
    }
}

/// The deck; `behavior` is `*SURFACE BEHAVIOR` with its data lines, the unit of stress the MPa.
pub fn deck(n: u32, behavior: &str, drive: Drive) -> String {
    let mut mesh = Mesh { text: String::new(), elements: String::new(), nodes: 0, bricks: 0 };
    let m = (29 * n).div_ceil(20).max(4);
    let punch = mesh.block("PUNCH", n, (n / 2).max(2), [1.0, 1.0, 0.0], [1.0, 0.5]);
    let foundation = mesh.block("FOUNDATION", m, (m / 2).max(2), [0.0, 0.0, -1.5], [3.0, 1.5]);
    let corner = |i: u32, j: u32| 2 * i > n && 2 * j > n;
    let sets = [
        ("NCORNER", punch.layer(punch.layers, corner)),
        ("NREST", punch.layer(punch.layers, |i, j| !corner(i, j))),
        ("NBOT", foundation.layer(0, |_, _| true)),
    ];
    let sets: String = sets.iter().map(|(name, nodes)| format!("*NSET, NSET={name}\n{nodes}")).collect();
    let surfaces = format!(
        "*SURFACE, NAME=SSL, TYPE=ELEMENT\n{}*SURFACE, NAME=SMA, TYPE=ELEMENT\n{}",
        punch.faces(0, 1),
        foundation.faces(foundation.layers - 1, 2)
    );
    let Mesh { text, elements, .. } = mesh;
    format!(
        "*NODE\n{text}{elements}{sets}{surfaces}\
         *MATERIAL, NAME=STIFF\n*ELASTIC\n210000., 0.3\n*SOLID SECTION, ELSET=PUNCH, MATERIAL=STIFF\n\
         *MATERIAL, NAME=SOFT\n*ELASTIC\n70000., 0.3\n*SOLID SECTION, ELSET=FOUNDATION, MATERIAL=SOFT\n\
         *SURFACE INTERACTION, NAME=CONTACT\n{behavior}\n\
         *CONTACT PAIR, INTERACTION=CONTACT, TYPE=NODE TO SURFACE, SMALL SLIDING\nSSL, SMA\n\
         *BOUNDARY\nNBOT, 1, 3\nNREST, 1, 2\nNCORNER, 1, 2\n\
         *STEP, INC=100000\n*STATIC\n1., 1.\n{}*END STEP\n",
        drive.lines()
    )
}
