//! Analytical rigid surfaces: a profile of lines and arcs, swept along a direction or around an axis.

/// An analytical rigid surface. It belongs to the rigid body that names it.
///
/// Local coordinates: `axes[0]`, `axes[1]`, `axes[2]` from `origin`. The profile lies in (x, y) and is swept along z, or in (r, z)
/// and is swept around z. The outward normal is the direction of the profile turned by 90 degrees anticlockwise.
#[derive(Clone, Debug, PartialEq)]
pub struct AnalyticalSurface {
    /// Position in `Model::rigid_bodies` of the body that it moves with.
    pub body: Option<u32>,
    /// How the profile is swept.
    pub sweep: Sweep,
    /// Origin of the local coordinates \[length\].
    pub origin: [f64; 3],
    /// Unit vectors of the local axes, right-handed.
    pub axes: [[f64; 3]; 3],
    /// Segments of the profile, each beginning where the one before ends.
    pub segments: Vec<Segment>,
}

/// How a profile is swept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sweep {
    /// `TYPE=CYLINDER`: along the local z-axis, without end.
    Translation,
    /// `TYPE=REVOLUTION`: around the local z-axis.
    Revolution,
}

/// Segment of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// Where it begins.
    pub start: [f64; 2],
    /// Where it ends.
    pub end: [f64; 2],
    /// Centre of an arc, which is shorter than 180 degrees; none for a line.
    pub centre: Option<[f64; 2]>,
}
