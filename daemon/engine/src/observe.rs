//! Results of the present state: contact points, pair totals, energies, output ports, history.

use crate::element::quad::cross;
use crate::outputs::Source;
use crate::procedure::interference;
use crate::procedure::rows::Moment;
use crate::simulation::{ContactPointResult, ContactStatus, Energies, HistoryRow, PairTotals, Simulation, WorkCounts};
use crate::state::Motion;

impl Simulation {
    /// Computes overclosures and results from the state alone, as after a restore.
    pub(crate) fn recompute(&mut self) {
        let prepared = self.prepared.clone();
        if self.state.motion.is_some() {
            self.moved_overclosures();
            self.refresh();
            return;
        }
        let coefficients = std::mem::take(&mut self.state.coefficients);
        self.free_overclosures(&coefficients, self.state.step_time);
        self.state.coefficients = coefficients;
        let work = &mut self.work;
        prepared.statics().contact.relief(&self.state.forces, &mut work.relief);
        prepared.statics().contact.overclosures(&work.free, &work.relief, &self.state.motions, &mut work.overclosures);
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        let begun = self.state.counts.iter().any(|c| c.increments > 0);
        for i in (0..prepared.points.len()).filter(|&i| begun && moment.penetration_max(i).is_some()) {
            self.work.overclosures[i] = self.state.penetrations[i];
        }
        self.refresh();
    }

    /// Overclosures under the displacements of a dynamic step, into the work space.
    pub(crate) fn moved_overclosures(&mut self) {
        let prepared = self.prepared.clone();
        let (nodal, step) = (prepared.nodal(), self.state.step as usize);
        let Some(motion) = &self.state.motion else { return };
        let work = &mut self.work;
        work.overclosures.clear();
        let of_row = |row: usize| nodal.initial[row] - motion.offsets[row] + nodal.along(row, &motion.displacement);
        work.overclosures.extend((0..nodal.rows()).map(of_row));
        interference::allow(
            &prepared.model,
            &prepared.rows,
            &nodal.initial,
            step,
            self.step_starts[step],
            self.state.step_time,
            &mut work.overclosures,
        );
    }

    /// Status of a contact point.
    pub(crate) fn status(&self, moment: &Moment<'_>, i: usize) -> ContactStatus {
        let state = &self.state;
        match (state.closed[i], state.stuck[i]) {
            (true, true) => ContactStatus::Sticking,
            (true, false) if moment.is_rough(i) => ContactStatus::Slipping,
            (true, false) => ContactStatus::Closed,
            (false, _) if state.viscous[i] != 0.0 => ContactStatus::Viscous,
            (false, _) => ContactStatus::Open,
        }
    }

    /// Brings the derived results up to the state; the work space holds its overclosures and their relief.
    pub(crate) fn refresh(&mut self) {
        let prepared = self.prepared.clone();
        let (points, n) = (prepared.points.len(), prepared.rows.count());
        let moment = Self::moment(&prepared, self.state.step as usize, self.state.step_time);
        self.derived.points.clear();
        for (i, point) in prepared.points.iter().enumerate() {
            let state = &self.state;
            // A closed hard point is held at zero by its multiplier; what remains is rounding.
            let held = state.closed[i] && moment.is_exact(i);
            let result = ContactPointResult {
                status: self.status(&moment, i),
                clearance: if held { 0.0 } else { -self.work.overclosures[i] },
                pressure: state.forces[i] / point.area,
                viscous: state.viscous[i] / point.area,
                shear: [0.0; 2],
                viscous_shear: [0.0; 2],
                slip: [state.slip[i], state.slip[n + i]],
            };
            self.derived.points.push(result);
        }
        let (state, derived) = (&self.state, &mut self.derived);
        derived.overclosures.clone_from(&self.work.overclosures);
        derived.relief.clone_from(&self.work.relief);
        derived.pairs.clear();
        derived.pairs.resize(prepared.model.pairs.len(), PairTotals::default());
        for (i, point) in prepared.points.iter().enumerate() {
            let pair = &mut derived.pairs[point.pair as usize];
            // On the surface that the pair names first: what acts on the node, or what it acts with.
            let side = if point.mirrored { -1.0 } else { 1.0 };
            let force = point.normal.map(|n| side * state.forces[i] * n);
            let moment = cross(prepared.model.mesh.nodes[point.node.index()], force);
            for d in 0..3 {
                pair.force[d] += force[d];
                pair.moment[d] += moment[d];
            }
            if state.closed[i] {
                pair.area += point.area;
            }
        }
        for (k, tangential) in (points..).zip(&prepared.rows.tangential) {
            let (i, d) = (tangential.point as usize, usize::from(tangential.direction));
            let point = &prepared.points[i];
            derived.points[i].shear[d] = state.forces[k] / point.area;
            derived.points[i].viscous_shear[d] = state.viscous[k] / point.area;
            // The force of the row opposes the slip of the secondary node.
            let side = if point.mirrored { -1.0 } else { 1.0 };
            let force = point.tangents[d].map(|t| -side * state.forces[k] * t);
            let moment = cross(prepared.model.mesh.nodes[point.node.index()], force);
            let pair = &mut derived.pairs[point.pair as usize];
            for d in 0..3 {
                pair.shear_force[d] += force[d];
                pair.shear_moment[d] += moment[d];
            }
        }
        for pair in &mut derived.pairs {
            pair.force_magnitude = pair.force.iter().map(|f| f * f).sum::<f64>().sqrt();
        }
        if let Some(motion) = &state.motion {
            derived.energies = motion.energies;
            return;
        }
        let strain = prepared.statics().condensed.strain_energy(&state.coefficients, &state.forces, &derived.relief);
        // Multipliers store nothing: what they do along an overclosure is not given back.
        self.work.rows.clear();
        self.work.rows.extend((0..points).map(|i| moment.normal_row(state, i, state.closed[i], 0.0)));
        let contact = prepared.statics().contact.energy(&self.work.rows, &derived.overclosures, &state.closed);
        derived.energies = Energies {
            strain,
            contact,
            viscous: state.damping_work,
            external_work: state.external_work,
            total: strain + contact + state.damping_work - state.external_work,
            ..Energies::default()
        };
    }

    /// Output values in port order.
    ///
    /// # Panics
    /// If the length is not the number of outputs.
    pub fn observe(&self, outputs: &mut [f64]) {
        assert_eq!(outputs.len(), self.prepared.sources.len(), "one value per output port");
        for (out, &source) in outputs.iter_mut().zip(&self.prepared.sources) {
            *out = self.value(source);
        }
    }

    fn value(&self, source: Source) -> f64 {
        let pairs = &self.derived.pairs;
        let points = |pair: usize| {
            let here = move |(info, _): &(&crate::contact::points::ContactPoint, &ContactPointResult)| {
                info.pair as usize == pair
            };
            self.prepared.points.iter().zip(&self.derived.points).filter(here).map(|(_, result)| result)
        };
        let closed = |pair| points(pair).filter(|p| p.status.is_closed()).count();
        let count = |pick: fn(&WorkCounts) -> u32| self.state.counts.iter().map(|c| f64::from(pick(c))).sum();
        match source {
            Source::PairForce(pair, d) => pairs[pair].force[d],
            Source::PairForceMagnitude(pair) => pairs[pair].force_magnitude,
            Source::PairArea(pair) => pairs[pair].area,
            Source::PairPressureMax(pair) => points(pair).map(|p| p.pressure).fold(0.0, f64::max),
            // Finite for a pair without points too: the widest clearance there is.
            Source::PairClearanceMin(pair) => points(pair).map(|p| p.clearance).fold(f64::MAX, f64::min),
            Source::PairClosed(pair) => closed(pair) as f64,
            Source::PairOpen(pair) => (points(pair).count() - closed(pair)) as f64,
            Source::PairShear(pair, d) => pairs[pair].shear_force[d],
            Source::PairStatus(pair, status) => points(pair).filter(|p| p.status == status).count() as f64,
            Source::Generalised(column) => self.generalised(column),
            Source::Velocity(set, d) => self.mean_of_motion(set, d, |motion| &motion.velocity),
            Source::Acceleration(set, d) => self.mean_of_motion(set, d, |motion| &motion.acceleration),
            Source::Energy(index) => {
                let e = &self.derived.energies;
                [e.strain, e.kinetic, e.external_work, e.friction, e.viscous, e.contact, e.impact_loss, e.total][index]
            }
            Source::Increments => count(|c| c.increments),
            Source::EquilibriumIterations => count(|c| c.equilibrium_iterations),
            Source::SevereDiscontinuityIterations => count(|c| c.severe_discontinuity_iterations),
            Source::Cutbacks => count(|c| c.cutbacks),
            Source::Augmentations => count(|c| c.augmentations),
            Source::Impacts => count(|c| c.impacts),
            Source::LastStatusChange => self.state.last_change,
        }
    }

    /// Mean of a component of a nodal vector over a node set of the outputs; 0 in a static step and for an empty set.
    fn mean_of_motion(&self, set: usize, d: usize, vector: fn(&Motion) -> &Vec<[f64; 3]>) -> f64 {
        let prepared = &self.prepared;
        let nodes = &prepared.model.mesh.node_sets[prepared.outputs.sets[set].index()].nodes;
        match &self.state.motion {
            Some(motion) if !nodes.is_empty() => {
                let share = 1.0 / nodes.len() as f64;
                nodes.iter().map(|node| share * vector(motion)[node.index()][d]).sum()
            }
            _ => 0.0,
        }
    }

    /// Generalised value of a column under the present state; 0 where there is none.
    pub(crate) fn generalised(&self, column: Option<usize>) -> f64 {
        let Some(c) = column else { return 0.0 };
        let Some(motion) = &self.state.motion else {
            return self.prepared.statics().condensed.conjugate(c, self.state.response());
        };
        let column = &self.prepared.columns[c];
        let values = if column.is_displacement() { &motion.reaction } else { &motion.displacement };
        column.entries().iter().map(|&(node, d, share)| share * values[node.index()][usize::from(d)]).sum()
    }

    /// Energies of the present time; in an explicit step those of the start of the last increment.
    pub fn energies(&self) -> Energies {
        self.derived.energies
    }

    /// The history row of the present time.
    pub fn history(&self) -> HistoryRow {
        HistoryRow {
            pairs: self.derived.pairs.clone(),
            energies: self.derived.energies,
            reactions: self.prepared.outputs.set_reactions.iter().map(|r| r.map(|c| self.generalised(c))).collect(),
        }
    }
}
