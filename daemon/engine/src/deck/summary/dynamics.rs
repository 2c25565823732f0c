//! What a model says about its motion: operators, masses, damping.

use crate::model::{
    ExplicitControl, ExplicitIncrements, HalfIncrement, MassMatrix, MassScalingKind, Material, Procedure, Rayleigh,
};

/// Rayleigh damping of a material.
pub fn describe_damping(material: &Material) -> String {
    let Rayleigh { alpha, beta } = material.damping;
    format!("{}: Rayleigh, alpha {alpha} and beta {beta}", material.name)
}

/// How a dynamic step is integrated; nothing for a static one.
pub fn describe_dynamics(procedure: &Procedure) -> Vec<String> {
    match procedure {
        Procedure::Static(_) => Vec::new(),
        Procedure::Dynamic(control) => {
            let mass = match control.mass {
                MassMatrix::ByOrder => "mass lumped at elements of first order",
                MassMatrix::Lumped => "lumped mass",
                MassMatrix::Consistent => "consistent mass",
            };
            let residual = match control.half_increment {
                _ if control.direct => None,
                HalfIncrement::Unchecked => Some("half-increment residual not checked".to_string()),
                HalfIncrement::Force(force) => Some(format!("half-increment residual up to {force}")),
                HalfIncrement::Relative(factor) => {
                    Some(format!("half-increment residual up to {factor} of the largest force"))
                }
            };
            let start = (!control.initial_accelerations).then(|| "no accelerations at the start".to_string());
            [Some(format!("HHT with alpha {}", control.alpha)), Some(mass.into()), residual, start]
                .into_iter()
                .flatten()
                .collect()
        }
        Procedure::Explicit(control) => {
            let ExplicitControl {
                period: _,
                increments,
                increment_max,
                bulk_viscosity: [linear, quadratic],
                mass_scaling,
            } = control;
            let size = match increments {
                ExplicitIncrements::Automatic { scale } if *scale != 1.0 => {
                    Some(format!("{scale} of the stable increment"))
                }
                ExplicitIncrements::Automatic { .. } | ExplicitIncrements::Direct(_) => None,
            };
            let largest = increment_max.map(|size| format!("increments up to {size}"));
            let viscosity = format!("bulk viscosity {linear} and {quadratic}");
            let scaled = mass_scaling.iter().map(|scaling| match scaling.kind {
                MassScalingKind::Factor(factor) => format!("masses times {factor}"),
                MassScalingKind::Uniform(size) | MassScalingKind::BelowMin(size) | MassScalingKind::SetEqual(size) => {
                    format!("masses scaled to an increment of {size}")
                }
            });
            size.into_iter().chain(largest).chain([viscosity]).chain(scaled).collect()
        }
    }
}
