//! Anchors on an analytical surface: closest points of its profile in closed form.
//!
//! A position is taken into the plane of the profile; there the closest point of each line and arc is known. Like on a mesh
//! (`search.rs`) an anchor is a local minimum of the distance, at a vertex between two segments the direction is the line from the
//! vertex to the position, and beyond an end of the profile the overhang is limited.

use super::search::{Anchor, DIRECTION_COSINE, FACING_COSINE, HAIR, Query, TOUCHING};
use crate::element::quad::{dot, sub};
use crate::model::{AnalyticalSurface, Mesh, Segment, Sweep};

/// Closest point of a segment.
#[derive(Clone, Copy)]
struct Closest {
    foot: [f64; 2],
    /// Unit outward normal there.
    normal: [f64; 2],
    distance: f64,
    /// Whether the foot is the start (−1), the end (1) or between (0).
    end: i8,
}

fn minus(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] - b[0], a[1] - b[1]]
}

fn length(a: [f64; 2]) -> f64 {
    a[0].hypot(a[1])
}

/// Size of a segment: length of a line, radius of an arc.
fn size(segment: &Segment) -> f64 {
    match segment.centre {
        None => length(minus(segment.end, segment.start)),
        Some(centre) => length(minus(segment.start, centre)),
    }
}

/// Unit tangent of a segment at a point of it, in the direction of the profile.
fn tangent(segment: &Segment, at: [f64; 2]) -> [f64; 2] {
    let along = match segment.centre {
        None => minus(segment.end, segment.start),
        Some(centre) => {
            let (from, to, arm) = (minus(segment.start, centre), minus(segment.end, centre), minus(at, centre));
            // Shorter than 180 degrees: anticlockwise if the end is on the left of the start.
            let turn = if from[0] * to[1] - from[1] * to[0] >= 0.0 { 1.0 } else { -1.0 };
            [-turn * arm[1], turn * arm[0]]
        }
    };
    let size = length(along);
    [along[0] / size, along[1] / size]
}

fn closest(segment: &Segment, p: [f64; 2]) -> Closest {
    let (from, to) = (segment.start, segment.end);
    let inner = match segment.centre {
        None => {
            let along = minus(to, from);
            let t =
                (minus(p, from)[0] * along[0] + minus(p, from)[1] * along[1]) / (along[0].powi(2) + along[1].powi(2));
            (t > 0.0 && t < 1.0).then(|| [from[0] + t * along[0], from[1] + t * along[1]])
        }
        Some(centre) => {
            let (arm, radius) = (minus(p, centre), length(minus(from, centre)));
            let distance = length(arm);
            let cross = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
            let (a, b) = (minus(from, centre), minus(to, centre));
            let turn = cross(a, b).signum();
            let between = turn * cross(a, arm) > 0.0 && turn * cross(arm, b) > 0.0;
            (distance > 0.0 && between)
                .then(|| [centre[0] + radius * arm[0] / distance, centre[1] + radius * arm[1] / distance])
        }
    };
    let (foot, end) = match inner {
        Some(foot) => (foot, 0),
        None if length(minus(p, from)) <= length(minus(p, to)) => (from, -1),
        None => (to, 1),
    };
    let [x, y] = tangent(segment, foot);
    Closest { foot, normal: [-y, x], distance: length(minus(p, foot)), end }
}

impl AnalyticalSurface {
    /// A position in the plane of the profile, and the directions of the plane's axes there.
    fn plane(&self, position: [f64; 3]) -> ([f64; 2], [[f64; 3]; 2]) {
        let from = sub(position, self.origin);
        let [x, y, z] = self.axes.map(|axis| dot(from, axis));
        match self.sweep {
            Sweep::Translation => ([x, y], [self.axes[0], self.axes[1]]),
            Sweep::Revolution => {
                let radius = x.hypot(y);
                let radial = match radius > 0.0 {
                    true => std::array::from_fn(|i| (x * self.axes[0][i] + y * self.axes[1][i]) / radius),
                    // On the axis every direction is as good.
                    false => self.axes[0],
                };
                ([radius, z], [radial, self.axes[2]])
            }
        }
    }

    /// Neighbour of a segment at its start (−1) or end (1), in a closed profile around its seam.
    fn neighbour(&self, index: usize, end: i8) -> Option<usize> {
        let count = self.segments.len();
        let size = size(&self.segments[index]);
        let joined = |a: usize, b: usize| length(minus(self.segments[a].end, self.segments[b].start)) <= HAIR * size;
        match end {
            -1 if index > 0 => Some(index - 1),
            1 if index + 1 < count => Some(index + 1),
            -1 => (count > 1 && joined(count - 1, 0)).then_some(count - 1),
            _ => (count > 1 && joined(count - 1, 0)).then_some(0),
        }
    }

    /// The anchor on a segment, if it is a local minimum and the secondary side looks at it.
    fn local_minimum(&self, index: usize, position: [f64; 3], query: Query) -> Option<Anchor> {
        let (p, axes) = self.plane(position);
        let segment = &self.segments[index];
        let own = closest(segment, p);
        let size = size(segment);
        let mut line = minus(p, own.foot);
        let mut normal = own.normal;
        if own.end != 0 {
            match self.neighbour(index, own.end) {
                Some(other) => {
                    let there = closest(&self.segments[other], p);
                    if there.distance < own.distance - HAIR * size || (other < index && there.end == -own.end) {
                        return None;
                    }
                    let sum = [normal[0] + there.normal[0], normal[1] + there.normal[1]];
                    let bisector = length(sum);
                    if bisector <= HAIR {
                        return None;
                    }
                    normal = [sum[0] / bisector, sum[1] / bisector];
                    let far = length(line);
                    if far > TOUCHING * size {
                        let side = line[0] * normal[0] + line[1] * normal[1];
                        normal = [line[0] / far.copysign(side), line[1] / far.copysign(side)];
                    }
                }
                // A profile that ends on its axis of revolution goes on behind it.
                None if self.sweep == Sweep::Revolution && own.foot[0] <= HAIR * size => {}
                None => {
                    let [x, y] = tangent(segment, own.foot);
                    let over = f64::from(own.end) * (line[0] * x + line[1] * y);
                    if over > (query.extension_zone + HAIR) * size {
                        return None;
                    }
                    let out = over.max(0.0) * f64::from(own.end);
                    line = [line[0] - out * x, line[1] - out * y];
                }
            }
        }
        let space = |v: [f64; 2]| std::array::from_fn(|i| v[0] * axes[0][i] + v[1] * axes[1][i]);
        let direction: [f64; 3] = space(normal);
        if query.outward.is_some_and(|outward| dot(outward, direction) > FACING_COSINE) {
            return None;
        }
        let clearance = line[0] * normal[0] + line[1] * normal[1];
        Some(Anchor {
            face: index as u32,
            natural: [0.0; 2],
            foot: std::array::from_fn(|i| position[i] - clearance * direction[i]),
            normal: direction,
            clearance,
            distance: own.distance,
        })
    }

    /// Anchors of a secondary node: the nearest first, further ones in clearly other directions.
    pub fn anchors(&self, mesh: &Mesh, query: Query) -> Vec<Anchor> {
        let position = mesh.nodes[query.node.index()];
        let mut found: Vec<Anchor> =
            (0..self.segments.len()).filter_map(|index| self.local_minimum(index, position, query)).collect();
        found.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.face.cmp(&b.face)));
        let Some(nearest) = found.first().copied() else { return found };
        let mut kept = vec![nearest];
        for anchor in found.into_iter().skip(1).filter(|_| query.outward.is_some()) {
            let size = size(&self.segments[anchor.face as usize]);
            let overlap = 2.0 * (-nearest.clearance).max(0.0) + TOUCHING * size;
            let apart = kept.iter().all(|k| dot(k.normal, anchor.normal) < DIRECTION_COSINE);
            if apart && anchor.clearance >= -overlap && anchor.distance <= nearest.distance + size {
                kept.push(anchor);
            }
        }
        kept
    }

    /// Whether an anchor's segment sweeps a plane: then sliding along it changes nothing.
    pub fn is_plane(&self, anchor: &Anchor) -> bool {
        self.sweep == Sweep::Translation && self.segments[anchor.face as usize].centre.is_none()
    }

    /// Size of an anchor's segment \[length\].
    pub fn size(&self, anchor: &Anchor) -> f64 {
        size(&self.segments[anchor.face as usize])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::NodeId;

    const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

    fn line(start: [f64; 2], end: [f64; 2]) -> Segment {
        Segment { start, end, centre: None }
    }

    fn arc(start: [f64; 2], end: [f64; 2]) -> Segment {
        Segment { start, end, centre: Some([0.0; 2]) }
    }

    fn surface(sweep: Sweep, segments: Vec<Segment>) -> AnalyticalSurface {
        AnalyticalSurface { body: None, sweep, origin: [1.0, 2.0, 3.0], axes: AXES, segments }
    }

    /// Anchors of a position, given from the origin of the surface.
    fn anchors(surface: &AnalyticalSurface, at: [f64; 3], outward: Option<[f64; 3]>) -> Vec<Anchor> {
        let mesh = Mesh { nodes: vec![std::array::from_fn(|i| at[i] + surface.origin[i])], ..Mesh::default() };
        surface.anchors(&mesh, Query { node: NodeId(0), outward, extension_zone: 0.1 })
    }

    fn check(anchor: &Anchor, clearance: f64, normal: [f64; 3]) {
        assert!((anchor.clearance - clearance).abs() < 1e-13, "{anchor:?}: {clearance}");
        assert!(anchor.normal.iter().zip(normal).all(|(a, b)| (a - b).abs() < 1e-13), "{anchor:?}: {normal:?}");
    }

    #[test]
    fn a_plane_looks_to_the_left_of_its_profile() {
        let plane = surface(Sweep::Translation, vec![line([-2.0, 0.5], [2.0, 0.5])]);
        for (height, z) in [(0.7, 5.0), (0.2, -40.0)] {
            let found = anchors(&plane, [1.0, height, z], None);
            assert_eq!(found.len(), 1);
            check(&found[0], height - 0.5, [0.0, 1.0, 0.0]);
            assert_eq!(found[0].foot.map(|x| (1e9 * x).round() / 1e9), [2.0, 2.5, 3.0 + z]);
        }
        // Beyond the end: a tenth of the segment is allowed, and taken out of the distance.
        check(&anchors(&plane, [2.3, 0.7, 0.0], None)[0], 0.2, [0.0, 1.0, 0.0]);
        assert!(anchors(&plane, [2.5, 0.7, 0.0], None).is_empty());
        // A side that looks the same way does not see it.
        assert!(anchors(&plane, [0.0, 0.7, 0.0], Some([0.0, 1.0, 0.0])).is_empty());
        assert_eq!(anchors(&plane, [0.0, 0.7, 0.0], Some([0.0, -1.0, 0.0])).len(), 1);
    }

    #[test]
    fn a_cylinder_of_four_arcs_is_round_from_outside_and_a_bore_from_inside() {
        let corners = [[2.0, 0.0], [0.0, -2.0], [-2.0, 0.0], [0.0, 2.0]];
        let clockwise: Vec<_> = (0..4).map(|i| arc(corners[i], corners[(i + 1) % 4])).collect();
        let shaft = surface(Sweep::Translation, clockwise);
        let anticlockwise = (0..4).map(|i| arc(corners[(4 - i) % 4], corners[3 - i])).collect();
        let bore = surface(Sweep::Translation, anticlockwise);
        for (x, y) in [(1.8, 2.4), (-3.0, 0.0), (0.0, 2.5), (0.7, -1.0), (0.0, -1.9)] {
            let radius = f64::hypot(x, y);
            let n = [x / radius, y / radius, 0.0];
            let found = anchors(&shaft, [x, y, 7.0], None);
            assert_eq!(found.len(), 1, "{x} {y}");
            check(&found[0], radius - 2.0, n);
            let found = anchors(&bore, [x, y, 7.0], Some(n));
            assert_eq!(found.len(), 1, "{x} {y}");
            check(&found[0], 2.0 - radius, n.map(|x| -x));
        }
    }

    #[test]
    fn spheres_and_cones_come_from_arcs_and_lines_around_the_axis() {
        // From the equator down to the pole.
        let sphere = surface(Sweep::Revolution, vec![arc([5.0, 0.0], [0.0, -5.0])]);
        for at in [[1.0, 2.0, -6.0], [0.0, 0.0, -4.5], [-3.0, 0.1, -3.0]] {
            let radius = at.iter().map(|x| x * x).sum::<f64>().sqrt();
            let found = anchors(&sphere, at, None);
            assert_eq!(found.len(), 1);
            check(&found[0], radius - 5.0, at.map(|x| x / radius));
        }
        // A cone that opens upwards with 3 : 4, its tip at the origin: from its rim to the tip it looks outwards and down.
        let cone = surface(Sweep::Revolution, vec![line([6.0, 8.0], [0.0, 0.0])]);
        let found = anchors(&cone, [0.0, 4.0, 2.0], None);
        // Distance of (4, 2) from the line through (6, 8): (8 · 4 − 6 · 2) / 10.
        check(&found[0], 2.0, [0.0, 0.8, -0.6]);
        // Below the tip the nearest point is the tip itself.
        check(&anchors(&cone, [0.0, 0.0, -1.0], None)[0], 0.6, [0.8, 0.0, -0.6]);
    }

    #[test]
    fn a_convex_edge_points_to_the_position_and_a_corner_has_two_anchors() {
        // A ridge: up the slope and down again; outward is up.
        let ridge = surface(Sweep::Translation, vec![line([-1.0, -1.0], [0.0, 0.0]), line([0.0, 0.0], [1.0, -1.0])]);
        let found = anchors(&ridge, [0.3, 0.4, 0.0], None);
        assert_eq!(found.len(), 1);
        check(&found[0], 0.5, [0.6, 0.8, 0.0]);
        // A corner: down the wall, along the floor; outward is to the right and up.
        let corner = surface(Sweep::Translation, vec![line([0.0, 3.0], [0.0, 0.0]), line([0.0, 0.0], [3.0, 0.0])]);
        let outward = Some([-0.5f64.sqrt(), -0.5f64.sqrt(), 0.0]);
        let found = anchors(&corner, [0.2, 0.1, 0.0], outward);
        assert_eq!(found.len(), 2);
        check(&found[0], 0.1, [0.0, 1.0, 0.0]);
        check(&found[1], 0.2, [1.0, 0.0, 0.0]);
    }
}
