//! How a dynamic step begins: displacements of what went before, velocities, and energies to compare with.

use crate::model::BoundaryKind;
use crate::simulation::{Energies, Simulation};
use crate::state::Motion;

impl Simulation {
    /// At the start of a step: a motion for a dynamic one, none for a static one. The first dynamic step has the initial
    /// velocities, a later one those that the motion has; behind a static step everything is at rest.
    pub(crate) fn begin_motion(&mut self) {
        let prepared = self.prepared.clone();
        let model = &prepared.model;
        let step = self.state.step as usize;
        if !model.steps[step].procedure.is_dynamic() {
            self.end_motion();
            return;
        }
        let nodes = model.mesh.nodes.len();
        let mut motion = match self.state.motion.take() {
            Some(motion) => motion,
            None => {
                let displacement = if step == 0 { vec![[0.0; 3]; nodes] } else { self.recover().displacement };
                let mut velocity = vec![[0.0; 3]; nodes];
                if !model.steps[..step].iter().any(|before| before.procedure.is_dynamic()) {
                    for initial in &model.initial_velocities {
                        velocity[initial.node.index()][usize::from(initial.direction)] = initial.value;
                    }
                }
                prepared.nodal().extend(&mut velocity);
                // A direction whose velocity or acceleration is prescribed begins with its initial velocity.
                let kinds = &prepared.loading.kinds[step];
                let begins = |(&rate, &kind): (&f64, &BoundaryKind)| {
                    if kind == BoundaryKind::Displacement { 0.0 } else { rate }
                };
                let rates = prepared.loading.rates_initial.iter().zip(kinds).map(begins).collect();
                let energies = Energies {
                    external_work: self.state.external_work,
                    viscous: self.state.damping_work,
                    ..Energies::default()
                };
                Motion {
                    energies,
                    displacement,
                    velocity,
                    acceleration: vec![[0.0; 3]; nodes],
                    reaction: vec![[0.0; 3]; nodes],
                    offsets: vec![0.0; prepared.rows.count()],
                    opened: vec![false; prepared.points.len()],
                    rates,
                    rates_start: vec![0.0; prepared.real_columns],
                    curvatures: vec![0.0; prepared.real_columns],
                    ..Motion::default()
                }
            }
        };
        motion.rates_start.clone_from(&motion.rates);
        // Not begun yet.
        motion.increment_last = 0.0;
        self.state.motion = Some(motion);
    }

    /// A static step behind a dynamic one begins at rest where that has ended.
    fn end_motion(&mut self) {
        let Some(energies) = self.state.motion.as_ref().map(|motion| motion.energies) else { return };
        self.state.conjugates = (0..self.prepared.real_columns).map(|column| self.generalised(Some(column))).collect();
        (self.state.external_work, self.state.damping_work) = (energies.external_work, energies.viscous);
        self.state.penetrations.clone_from_slice(&self.derived.overclosures[..self.prepared.points.len()]);
        self.state.motion = None;
    }
}
