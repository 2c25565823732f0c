//! Fields: displacements, reactions and stresses of the whole mesh, recovered by one solve.

use crate::element::{self, Coordinates, connector};
use crate::model::{Connector, ElementId, NodeId};
use crate::simulation::{Field, FieldError, NodalSolution, Simulation};
use crate::solve::assembly::coordinates;
use crate::solve::budget::Budget;
use crate::solve::columns::Column;
use crate::solve::numbering::NOT_FREE;
use crate::solve::reactions;

/// Stress (11, 22, 33, 12, 13, 23) at the integration points of an element [pressure].
pub type ElementStress = Vec<[f64; 6]>;

/// Fields that [`Simulation::field`] knows in every step, and those of dynamic steps.
const FIELDS: &str = "U, UR, RF, RM, S, CPRESS, CSHEAR, CDPRESS, CDSHEAR, COPEN, CSLIP, CSTATUS";
const FIELDS_OF_MOTION: &str = "V, VR, A, AR";

impl Simulation {
    /// Displacements and reactions of all nodes: one backward solve per body.
    pub fn recover(&self) -> NodalSolution {
        let prepared = &self.prepared;
        if let Some(motion) = &self.state.motion {
            return NodalSolution {
                displacement: motion.displacement.clone(),
                velocity: motion.velocity.clone(),
                acceleration: motion.acceleration.clone(),
                reaction: motion.reaction.clone(),
            };
        }
        let (coefficients, forces) = (&self.state.coefficients, &self.state.forces);
        let mut displacement = vec![[0.0; 3]; prepared.model.mesh.nodes.len()];
        for (column, &a) in prepared.loading.columns.iter().zip(coefficients) {
            if let Column::Displacement(entries) = column {
                for &(node, direction, value) in entries {
                    displacement[node.index()][direction as usize] += a * value;
                }
            }
        }
        let budget = Budget::default();
        let context = prepared.context(&budget);
        for (body, elements) in prepared.statics().bodies.iter().zip(&prepared.numbering.elements) {
            let unknowns = body.recover(&context, elements, coefficients, forces);
            for (node, directions) in body.nodes.iter().zip(&body.unknowns) {
                for (u, &unknown) in displacement[node.index()].iter_mut().zip(directions) {
                    if unknown != NOT_FREE {
                        *u = unknowns[unknown as usize];
                    }
                }
            }
        }
        self.add_motions(&mut displacement);
        self.add_dependents(&mut displacement);
        let reaction = self.reactions(&displacement);
        NodalSolution { displacement, reaction, ..NodalSolution::default() }
    }

    /// Adds `R α` on the free directions.
    fn add_motions(&self, displacement: &mut [[f64; 3]]) {
        let prepared = &self.prepared;
        for (b, motions) in prepared.motions.iter().enumerate().filter(|(_, m)| m.count() > 0) {
            let amounts = &self.state.motions[prepared.floating.offsets[b]..];
            for (local, node) in prepared.numbering.nodes[b].iter().enumerate() {
                for direction in (0..3).filter(|&d| prepared.constraints.is_free(*node, d)) {
                    let moved: f64 = (0..motions.count()).map(|m| amounts[m] * motions.at(m, local, direction)).sum();
                    displacement[node.index()][direction] += moved;
                }
            }
        }
    }

    /// Adds to dependent directions what the free ones give them; the prescribed ones have done so through their columns.
    fn add_dependents(&self, displacement: &mut [[f64; 3]]) {
        let constraints = &self.prepared.constraints;
        for ((node, direction), terms) in constraints.dependents() {
            let moved: f64 = (terms.iter())
                .filter(|&&(n, d, _)| constraints.is_free(n, usize::from(d)))
                .map(|&(n, d, factor)| factor * displacement[n.index()][usize::from(d)])
                .sum();
            displacement[node.index()][usize::from(direction)] += moved;
        }
    }

    /// `RF = K u − f + Bᵀ F` on the prescribed directions, with the share of those that depend on them.
    fn reactions(&self, displacement: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let prepared = &self.prepared;
        let mut reaction = vec![[0.0; 3]; displacement.len()];
        let constraints = &prepared.constraints;
        let mut add = |node: NodeId, direction: usize, force: f64| {
            constraints.expand(node, direction, force, |n, d, share| {
                if constraints.is_prescribed(n, d) {
                    reaction[n.index()][d] += share;
                }
            });
        };
        reactions::internal_forces(
            &prepared.model,
            &prepared.elasticities,
            &prepared.support_elements,
            displacement,
            &mut add,
        );
        for (column, &a) in prepared.loading.columns.iter().zip(&self.state.coefficients) {
            if let Column::Force(entries) = column {
                for &(node, direction, value) in entries {
                    add(node, direction as usize, -a * value);
                }
            }
        }
        for (point, &force) in prepared.points.iter().zip(&self.state.forces).filter(|(_, f)| **f != 0.0) {
            point.row(point.normal.map(|x| -x), |node, direction, value| add(node, direction, value * force));
        }
        reaction
    }

    /// Stress at the integration points of one element.
    pub fn element_stress(&self, solution: &NodalSolution, element: ElementId) -> ElementStress {
        let mesh = &self.prepared.model.mesh;
        let nodes = mesh.elements.nodes(element.index());
        if let Some(&section) = mesh.connectors.get(&element) {
            return self.connector_stress(solution, element, section);
        }
        element::stress(
            mesh.elements.kind(element.index()),
            &coordinates(mesh, element.0),
            self.prepared.elasticities[mesh.element_materials[element.index()].index()],
            &Coordinates::of(nodes.iter().map(|n| solution.displacement[n.index()])),
        )
    }

    /// A bar has one stress, a spring gives its force instead, a mass has nothing.
    fn connector_stress(&self, solution: &NodalSolution, element: ElementId, section: Connector) -> ElementStress {
        let mesh = &self.prepared.model.mesh;
        let u = Coordinates::of(mesh.elements.nodes(element.index()).iter().map(|n| solution.displacement[n.index()]));
        let material = mesh.element_materials[element.index()];
        let youngs_modulus = self.prepared.elasticities.get(material.index()).map_or(0.0, |e| e.youngs_modulus());
        let kind = mesh.elements.kind(element.index());
        let force = connector::force(kind, &coordinates(mesh, element.0), section, youngs_modulus, &u);
        match section {
            Connector::Bar { area } => vec![[force / area, 0.0, 0.0, 0.0, 0.0, 0.0]],
            Connector::Spring { .. } => vec![[force, 0.0, 0.0, 0.0, 0.0, 0.0]],
            Connector::Dashpot { .. } | Connector::Mass { .. } | Connector::RotaryInertia { .. } | Connector::Inert => {
                Vec::new()
            }
        }
    }

    /// Stress at the nodes (11, 22, 33, 12, 13, 23): extrapolated from the integration points and averaged over
    /// the solids at each node; zero at nodes without solids.
    pub fn nodal_stress(&self, solution: &NodalSolution) -> Vec<[f64; 6]> {
        let mesh = &self.prepared.model.mesh;
        let mut sum = vec![[0.0; 6]; mesh.nodes.len()];
        let mut count = vec![0u32; mesh.nodes.len()];
        for (e, (kind, nodes)) in mesh.elements.iter().enumerate().filter(|(_, (kind, _))| kind.is_solid()) {
            let stress = self.element_stress(solution, crate::model::ElementId(e as u32));
            for (node, s) in nodes.iter().zip(element::extrapolate(kind, &stress)) {
                count[node.index()] += 1;
                for (total, value) in sum[node.index()].iter_mut().zip(s) {
                    *total += value;
                }
            }
        }
        for (s, n) in sum.iter_mut().zip(count) {
            if n > 0 {
                for value in s {
                    *value /= f64::from(n);
                }
            }
        }
        sum
    }

    /// A field by name.
    pub fn field(&self, name: &str) -> Result<Field, FieldError> {
        let mesh = &self.prepared.model.mesh;
        let nodal = |components: usize, values: Vec<f64>| Field {
            name: name.into(),
            labels: mesh.node_labels[..mesh.node_count()].to_vec(),
            components,
            values,
        };
        let turning = |values: Vec<[f64; 3]>| Field {
            name: name.into(),
            labels: mesh.rotations.iter().map(|(node, _)| mesh.node_labels[node.index()]).collect(),
            components: 3,
            values: mesh.rotations.iter().flat_map(|(_, hidden)| values[hidden.index()]).collect(),
        };
        let own = |mut values: Vec<[f64; 3]>| {
            values.truncate(mesh.node_count());
            values.into_flattened()
        };
        let contact = |components: usize, values: Vec<f64>| Field {
            name: name.into(),
            labels: self.prepared.points.iter().map(|p| mesh.node_labels[p.node.index()]).collect(),
            components,
            values,
        };
        let points = &self.derived.points;
        if let Some(motion) = &self.state.motion {
            match name {
                "V" => return Ok(nodal(3, own(motion.velocity.clone()))),
                "VR" => return Ok(turning(motion.velocity.clone())),
                "A" => return Ok(nodal(3, own(motion.acceleration.clone()))),
                "AR" => return Ok(turning(motion.acceleration.clone())),
                _ => {}
            }
        }
        match name {
            "U" => Ok(nodal(3, own(self.recover().displacement))),
            "UR" => Ok(turning(self.recover().displacement)),
            "RF" => Ok(nodal(3, own(self.recover().reaction))),
            "RM" => Ok(turning(self.recover().reaction)),
            "S" => {
                let mut stress = self.nodal_stress(&self.recover());
                stress.truncate(mesh.node_count());
                Ok(nodal(6, stress.into_flattened()))
            }
            "CPRESS" => Ok(contact(1, points.iter().map(|p| p.pressure).collect())),
            "COPEN" => Ok(contact(1, points.iter().map(|p| p.clearance).collect())),
            "CSTATUS" => Ok(contact(1, points.iter().map(|p| f64::from(p.status.number())).collect())),
            "CSHEAR" => Ok(contact(2, points.iter().flat_map(|p| p.shear).collect())),
            "CDPRESS" => Ok(contact(1, points.iter().map(|p| p.viscous).collect())),
            "CDSHEAR" => Ok(contact(2, points.iter().flat_map(|p| p.viscous_shear).collect())),
            "CSLIP" => Ok(contact(2, points.iter().flat_map(|p| p.slip).collect())),
            _ => {
                let available = match self.state.motion {
                    Some(_) => format!("{FIELDS}, {FIELDS_OF_MOTION}"),
                    None => FIELDS.into(),
                };
                Err(FieldError { name: name.into(), available })
            }
        }
    }
}
