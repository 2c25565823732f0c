//! Where Abaqus and CalculiX mean different things by the same lines, and what the reader takes them for.

/// One difference between the dialects.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Difference {
    /// Keyword, with what it is about.
    pub subject: &'static str,
    /// What Abaqus means: how the dialect `abaqus` reads it.
    pub abaqus: &'static str,
    /// What CalculiX means.
    pub calculix: &'static str,
    /// How the dialect `calculix` reads it, and why where that is not what CalculiX does.
    pub read_as: &'static str,
    /// Whether the dialect `calculix` follows CalculiX.
    pub follows_calculix: bool,
}

const fn follows(
    subject: &'static str,
    abaqus: &'static str,
    calculix: &'static str,
    read_as: &'static str,
) -> Difference {
    Difference { subject, abaqus, calculix, read_as, follows_calculix: true }
}

const fn departs(
    subject: &'static str,
    abaqus: &'static str,
    calculix: &'static str,
    read_as: &'static str,
) -> Difference {
    Difference { subject, abaqus, calculix, read_as, follows_calculix: false }
}

const DIFFERENCES: &[Difference] = &[
    follows(
        "*ELEMENT, TYPE=C3D8",
        "the volumetric strain is averaged over the element (selectively reduced integration)",
        "all strains are integrated at 2x2x2 points",
        "as CalculiX",
    ),
    departs(
        "*ELEMENT, TYPE=C3D8I",
        "thirteen incompatible modes: nine of the displacement gradient and four against volumetric locking",
        "incompatible modes of its own, with a correction of shear",
        "in both dialects nine incompatible modes (Taylor, Beresford, Wilson) on the fully integrated brick",
    ),
    follows(
        "*ELEMENT, TYPE=C3D8R",
        "mean strain with an hourglass stiffness in proportion to 0.005 times the shear modulus",
        "mean strain with an hourglass stiffness in proportion to 0.0005 times Young's modulus",
        "as CalculiX",
    ),
    departs(
        "*DLOAD on C3D6, GRAV on C3D6 and C3D20R",
        "consistent with the shape functions",
        "pressure on quadrilateral faces of C3D6 at one point; gravity at the points of the stiffness",
        "consistent in both dialects: the resultants agree, and on undistorted elements the nodal loads do",
    ),
    follows(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL",
        "p = p0/(e-1) (1+h/c0) (exp(1+h/c0) - 1) for h > -c0, straight beyond h = 6 c0",
        "p = p0 100^(h/c0), cut to 0 below h = -c0, where 1 % of p0 is left",
        "as CalculiX's node-to-surface contact, straight far beyond h = 4.99 c0 where CalculiX caps the force",
    ),
    departs(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR",
        "one item, the slope K: p = K h for h > 0; more items are an error",
        "items K, sigma_inf, c0: the law is smoothed by an arctangent and pulls with up to sigma_inf at open points",
        "p = K h for h > 0; further items are ignored with a warning, because the smoothing lets open points pull and closed ones yield",
    ),
    departs(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD",
        "no overclosure, enforced exactly",
        "replaced by LINEAR with K = 50 times the modulus of the first material",
        "enforced exactly, with a warning: a stiffness that nobody chose is no answer",
    ),
    departs(
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TABULAR",
        "beyond the last point the last slope goes on",
        "outside the table the pressure is constant",
        "as Abaqus, with a warning: at constant pressure a body may fall through the other; below the first point the pressure is 0",
    ),
    departs(
        "*SURFACE INTERACTION without *SURFACE BEHAVIOR",
        "hard contact",
        "the run stops",
        "hard contact, with a warning",
    ),
    departs(
        "*CONTACT PAIR, contact elements",
        "a point far from the primary surface comes into contact when it gets there",
        "springs are made for points closer than c0 times the square root of their area",
        "as Abaqus: nothing is cut off",
    ),
    departs(
        "*CONTACT DAMPING",
        "coefficient, clearance c0 from which on nothing is damped, part of it with the full coefficient",
        "the coefficient alone: damps where contact springs are, at points closer than c0 times the square root of their area",
        "a coefficient alone damps where surfaces touch or overlap",
    ),
    departs(
        "*CONTACT PAIR, TYPE=SURFACE TO SURFACE",
        "constraints averaged over the secondary surface around each node",
        "springs at the integration points of the secondary faces, which begin at touch",
        "in both dialects node-to-surface, with a warning: the resultants agree, a uniform pressure is transmitted as one between matching meshes only, and laws that begin before touch do so",
    ),
    departs(
        "*CONTACT PAIR, ADJUST",
        "secondary nodes within the distance, or of the node set, are moved onto the primary surface without strain",
        "the same; a node in a corner is moved once",
        "in both dialects along the normal of the primary, in a corner against each side within the distance; the results show the moved coordinates",
    ),
    follows(
        "*SURFACE INTERACTION without an area, secondary surface of nodes",
        "each node stands for 1",
        "each node stands for its share of every outer face of a solid at it: the area of the face over the number of its corners; a node on no solid stands for the primary face under it",
        "as CalculiX; a node with midside nodes on its faces stands for 1, with a warning",
    ),
    departs("*CONTACT PAIR without TYPE", "node-to-surface", "the run stops", "node-to-surface"),
    departs(
        "*CONTACT PAIR, initial overclosure",
        "resolved in the first increment",
        "resolved over the first step",
        "as Abaqus",
    ),
    follows(
        "*BOUNDARY before the first step",
        "values are 0",
        "other values are reached over the first step",
        "as CalculiX, with a warning",
    ),
    follows(
        "*DLOAD, GRAV",
        "the direction is a direction only; the magnitude is the acceleration",
        "the acceleration is the magnitude times the vector, whatever its length",
        "as CalculiX",
    ),
    departs(
        "*EQUATION with node sets",
        "one equation for each node of the sets, paired by their numbers",
        "the run stops",
        "as Abaqus",
    ),
    departs(
        "*SPRING without a line of directions",
        "the first line is that of directions, blank for SPRINGA",
        "a first item without a decimal point is a direction",
        "in both dialects the type of the elements decides; the blank line of SPRINGA may be left out",
    ),
    follows(
        "*RESTART, WRITE, FREQUENCY=n",
        "a snapshot every n increments and at the end of the step",
        "a snapshot at the end of every n-th step",
        "as CalculiX",
    ),
    departs(
        "*CONTACT FILE, *CONTACT PRINT: COPEN",
        "clearance, positive when open",
        "clearances are stored as 0, overclosures as negative values",
        "as Abaqus",
    ),
];

/// Every place where the dialects differ.
pub fn differences() -> &'static [Difference] {
    DIFFERENCES
}
