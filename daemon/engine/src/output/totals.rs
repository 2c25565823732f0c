//! Totals of a contact pair as the manual names them: forces, moments about the origin, centres of force, area.

use super::components::traction;
use crate::simulation::{ContactPointInfo, ContactPointResult, PairTotals, PreparedModel};

/// Totals of a pair: of pressure (N), of friction (S), of both (T).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Resultants {
    /// CFN, CFS, CFT \[force\].
    pub force: [[f64; 3]; 3],
    /// CMN, CMS, CMT \[force·length\].
    pub moment: [[f64; 3]; 3],
    /// XN, XS, XT \[length\]: zero where there is no such force.
    pub centre: [[f64; 3]; 3],
    /// CAREA \[length²\].
    pub area: f64,
}

/// Force of a point, relative to the largest of all, that has no part in a centre.
const FORCE_ROUNDING: f64 = 1e-10;

/// Names of the families: force, moment and centre of pressure, of friction, and of both.
pub(super) const FAMILIES: [[&str; 3]; 3] = [["CFN", "CFS", "CFT"], ["CMN", "CMS", "CMT"], ["XN", "XS", "XT"]];

impl Resultants {
    /// Totals of every pair.
    pub(super) fn of_pairs(
        prepared: &PreparedModel,
        totals: &[PairTotals],
        contact: &[ContactPointResult],
    ) -> Vec<Self> {
        let mut all: Vec<Self> = totals.iter().map(Self::without_centres).collect();
        let mut weights = vec![[0.0; 3]; all.len()];
        let points = || prepared.contact_points().iter().zip(contact);
        let largest = points().map(|(point, result)| (traction(result)[2] * point.area).abs()).fold(0.0, f64::max);
        // Where forces are rounding, so would their centre be.
        let carries = |&(point, result): &(&ContactPointInfo, &ContactPointResult)| {
            (traction(result)[2] * point.area).abs() > FORCE_ROUNDING * largest
        };
        for (point, result) in points().filter(carries) {
            let at = prepared.model().mesh.nodes[point.node.index()];
            let (sums, weights) = (&mut all[point.pair as usize].centre, &mut weights[point.pair as usize]);
            for ((sum, weight), traction) in sums.iter_mut().zip(weights).zip(traction(result)) {
                *weight += traction * point.area;
                for (sum, x) in sum.iter_mut().zip(at) {
                    *sum += traction * point.area * x;
                }
            }
        }
        for (resultants, weights) in all.iter_mut().zip(weights) {
            for (centre, weight) in resultants.centre.iter_mut().zip(weights) {
                *centre = if weight == 0.0 { [0.0; 3] } else { centre.map(|sum| sum / weight) };
            }
        }
        all
    }

    fn without_centres(totals: &PairTotals) -> Self {
        let add = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        let PairTotals { force, force_magnitude: _, area, shear_force, moment, shear_moment } = *totals;
        Self {
            force: [force, shear_force, add(force, shear_force)],
            moment: [moment, shear_moment, add(moment, shear_moment)],
            centre: [[0.0; 3]; 3],
            area,
        }
    }

    /// A family by its name; `None` for a name that is none.
    pub(super) fn family(&self, name: &str) -> Option<[f64; 3]> {
        let rows = [&self.force, &self.moment, &self.centre];
        FAMILIES.iter().zip(rows).find_map(|(names, values)| {
            let position = names.iter().position(|known| *known == name)?;
            Some(values[position])
        })
    }
}

/// Length of a vector.
pub(super) fn magnitude(v: [f64; 3]) -> f64 {
    v.iter().map(|x| x * x).sum::<f64>().sqrt()
}
