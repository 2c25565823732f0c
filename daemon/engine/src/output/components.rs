//! Components at contact points by their names.

use crate::simulation::ContactPointResult;

/// Names of the components that are numbers, in the order of the tables.
pub(super) const COMPONENTS: [&str; 9] =
    ["CPRESS", "CSHEAR1", "CSHEAR2", "CDPRESS", "CDSHEAR1", "CDSHEAR2", "COPEN", "CSLIP1", "CSLIP2"];

/// Values in the order of [`COMPONENTS`].
pub(super) fn values(result: &ContactPointResult) -> [f64; 9] {
    let ContactPointResult { status: _, clearance, pressure, viscous, shear, viscous_shear, slip } = *result;
    [pressure, shear[0], shear[1], viscous, viscous_shear[0], viscous_shear[1], clearance, slip[0], slip[1]]
}

/// Pressure, shear, and both together with the sign of the pressure \[pressure\]: what the centres of force are weighed by.
pub(super) fn traction(result: &ContactPointResult) -> [f64; 3] {
    let shear = result.shear[0].hypot(result.shear[1]);
    [result.pressure, shear, result.pressure.hypot(shear).copysign(result.pressure)]
}
