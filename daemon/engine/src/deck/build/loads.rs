//! `*CLOAD`, `*DLOAD`, `*DSLOAD`, and the check that no two lines contradict each other.

use rustc_hash::FxHashMap;

use crate::model::{
    Connector, ElementFace, ElementId, ElementSet, Load, LoadKind, LoadsRemoved, MaterialId, NodeId, Region, SetId,
    SurfaceId, SurfaceKind,
};

use super::super::data::Row;
use super::super::lex::{key, unquoted};
use super::super::report::{At, excerpt};
use super::Builder;
use super::layout::StepCards;
use super::regions::Members;

const CLOAD: &str = "*CLOAD";
const DLOAD: &str = "*DLOAD";
const DSLOAD: &str = "*DSLOAD";

/// Name of the element set that a gravity load without a set acts on.
const WHOLE_MODEL: &str = "WHOLE_MODEL";

/// The smallest thing that a load acts on: what two lines may not claim both.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Atom {
    Node(u32, u8),
    Face(ElementFace),
    SurfaceFace(ElementFace),
    Body(ElementId),
}

impl Builder<'_> {
    /// Loads of a step, the line of each, and which loads of earlier steps it removes.
    pub(super) fn step_loads(&mut self, step: &StepCards<'_>) -> (Vec<Load>, Vec<At>, LoadsRemoved) {
        let (mut loads, mut places, mut removed) = (Vec::new(), Vec::new(), LoadsRemoved::default());
        let mut first_op: FxHashMap<&str, bool> = FxHashMap::default();
        for card in &step.cards {
            let flag = match card.keyword.name {
                CLOAD => &mut removed.cload,
                DLOAD => &mut removed.dload,
                DSLOAD => &mut removed.dsload,
                _ => continue,
            };
            let is_new = card.parameters.word("OP") == "NEW";
            *flag |= is_new;
            if *first_op.entry(card.keyword.name).or_insert(is_new) != is_new {
                let message = "OP=NEW and OP=MOD stand side by side in one step";
                self.report.error(card.at, card.keyword.name, message, "give every such card of the step the same OP");
            }
            let Ok(amplitude) = self.amplitude(card) else { continue };
            if card.faulty {
                continue;
            }
            for line in card.lines().iter() {
                let row = line.row(card.keyword.name);
                let load = match card.keyword.name {
                    CLOAD => self.concentrated(&row),
                    DLOAD => self.distributed(&row),
                    _ => self.on_surface(&row),
                };
                if let Some(load) = load {
                    loads.push(Load { amplitude, place: self.map.place(row.at), ..load });
                    places.push(row.at);
                }
            }
        }
        (loads, places, removed)
    }

    fn load(&self, region: Region, region_name: String, kind: LoadKind, magnitude: f64) -> Option<Load> {
        let place = crate::diagnostic::Place::nowhere();
        Some(Load { region, region_name, kind, magnitude, amplitude: None, place })
    }

    fn concentrated(&mut self, row: &Row<'_>) -> Option<Load> {
        row.at_most(3, self.report);
        let region = self.node_region(row);
        let dof = row.whole(1, "degree of freedom", None, self.report);
        let magnitude = row.real(2, "force", None, self.report);
        let (region, dof, magnitude) = (region?, dof?, magnitude?);
        let nodes: Vec<NodeId> = match dof {
            1..=3 => region.members,
            4..=6 => region.members.iter().filter_map(|&node| self.model.mesh.rotation_of(node)).collect(),
            _ => {
                let message = format!("degree of freedom {dof} does not exist");
                let remedy = "write 1 (x), 2 (y) or 3 (z), on reference nodes of rigid bodies also 4 to 6";
                self.report.error(row.at, CLOAD, message, remedy);
                return None;
            }
        };
        if nodes.is_empty() {
            let message = format!(
                "degree of freedom {dof} is ignored: only reference nodes of rigid bodies and nodes of ROTARYI have rotations"
            );
            self.report.warning(row.at, CLOAD, message, "apply the moment as forces");
            return None;
        }
        let kind = LoadKind::Concentrated { nodes, direction: ((dof - 1) % 3) as u8 };
        self.load(region.region, region.name, kind, magnitude)
    }

    fn distributed(&mut self, row: &Row<'_>) -> Option<Load> {
        let kind = key(row.text(1));
        match kind.as_bytes() {
            b"GRAV" => self.gravity(row),
            [b'P', digit @ b'1'..=b'6'] => {
                row.at_most(3, self.report);
                let region = self.element_region(row);
                let magnitude = row.real(2, "pressure", None, self.report);
                let (region, magnitude) = (region?, magnitude?);
                let label = digit - b'0';
                if let Some(message) = self.without_face(&region.members, label) {
                    self.report.error(
                        row.at,
                        DLOAD,
                        message,
                        "give the pressure element set by element set, one per type",
                    );
                    return None;
                }
                let face = |&element: &ElementId| ElementFace { element, face: label - 1 };
                let faces = region.members.iter().map(face).collect();
                self.load(region.region, region.name, LoadKind::FacePressure { faces, label }, magnitude)
            }
            _ => {
                let message = if kind.is_empty() {
                    "the load type is missing".into()
                } else {
                    format!("load type {} is not supported", excerpt(kind.as_bytes()))
                };
                self.report.error(row.at, DLOAD, message, "write P1 to P6 (pressure on a face) or GRAV (gravity)");
                None
            }
        }
    }

    fn gravity(&mut self, row: &Row<'_>) -> Option<Load> {
        row.at_most(6, self.report);
        let region = if row.text(0).is_empty() { self.whole_model(row) } else { self.element_region(row) };
        let magnitude = row.real(2, "acceleration", None, self.report);
        let mut vector = [0.0; 3];
        for (i, component) in vector.iter_mut().enumerate() {
            *component = row.real(3 + i, "component of the direction", Some(0.0), self.report)?;
        }
        let (region, mut magnitude) = (region?, magnitude?);
        let scale = vector.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        if scale == 0.0 {
            self.report.error(
                row.at,
                DLOAD,
                "the direction of gravity is missing",
                "write: element set, GRAV, acceleration, x, y, z",
            );
            return None;
        }
        let length = scale * vector.iter().map(|x| (x / scale).powi(2)).sum::<f64>().sqrt();
        let direction = vector.map(|x| x / length);
        if self.model.dialect == crate::model::Dialect::Calculix {
            magnitude *= length;
        }
        if !magnitude.is_finite() {
            self.report.error(
                row.at,
                DLOAD,
                "the acceleration is not a finite number",
                "give the direction as a unit vector",
            );
            return None;
        }
        self.has_density(row, &region.members);
        let section = |element: &ElementId| self.model.mesh.connectors.get(element);
        if region
            .members
            .iter()
            .all(|element| matches!(section(element), Some(Connector::Spring { .. } | Connector::Dashpot { .. })))
        {
            let message = format!("gravity on {} has no effect: springs and dashpots have no mass", region.name);
            self.report.warning(row.at, DLOAD, message, "give the weight to elements with mass, or add MASS elements");
        }
        let kind = LoadKind::Gravity { elements: region.members, direction };
        self.load(region.region, region.name, kind, magnitude)
    }

    /// All elements, as a set that is added to the model.
    fn whole_model(&mut self, row: &Row<'_>) -> Option<Members<ElementId>> {
        let count = self.model.mesh.elements.len();
        if !self.budget.take(4 * count, row.at, DLOAD, self.report) {
            return None;
        }
        let (position, is_new) = self.element_sets.enter(WHOLE_MODEL, row.at);
        let members: Vec<_> = (0..count as u32).map(ElementId).collect();
        if is_new {
            self.model.mesh.element_sets.push(ElementSet { name: WHOLE_MODEL.into(), elements: members.clone() });
        }
        Some(Members { region: Region::Set(SetId(position)), name: WHOLE_MODEL.into(), members })
    }

    fn has_density(&mut self, row: &Row<'_>, elements: &[ElementId]) {
        let mut materials: Vec<MaterialId> =
            elements.iter().map(|element| self.model.mesh.element_materials[element.index()]).collect();
        materials.sort_unstable();
        materials.dedup();
        for material in materials.iter().filter_map(|id| self.model.materials.get(id.index())) {
            if material.density.is_none() {
                let message = format!("gravity acts on elements of material {}, which has no density", material.name);
                self.report.error(row.at, DLOAD, message, "add *DENSITY to the material");
            }
        }
    }

    fn on_surface(&mut self, row: &Row<'_>) -> Option<Load> {
        row.at_most(3, self.report);
        let name = unquoted(row.text(0));
        let surface = self.surfaces.refer(name, row.at, DSLOAD, self.report);
        if key(row.text(1)) != "P" {
            let message = format!("load type {} is not supported", excerpt(row.text(1).as_bytes()));
            self.report.error(row.at, DSLOAD, message, "write P (pressure)");
            return None;
        }
        let magnitude = row.real(2, "pressure", None, self.report);
        let (surface, magnitude) = (surface?, magnitude?);
        let definition = &self.model.mesh.surfaces[surface as usize];
        let SurfaceKind::Faces(faces) = &definition.kind else {
            let message = format!("surface {} is made of nodes and takes no pressure", definition.name);
            self.report.error(row.at, DSLOAD, message, "define the surface by faces, or load its nodes with *CLOAD");
            return None;
        };
        if !self.budget.take(4 * faces.len(), row.at, DSLOAD, self.report) {
            return None;
        }
        let kind = LoadKind::SurfacePressure { faces: faces.clone() };
        self.load(Region::Surface(SurfaceId(surface)), definition.name.clone(), kind, magnitude)
    }

    /// Lines that act on the same nodes or faces: within a step they add; from step to step a line replaces only its own like.
    pub(super) fn check_loads(&mut self) {
        let mut active: FxHashMap<Atom, (usize, usize)> = FxHashMap::default();
        for (number, step) in self.model.steps.iter().enumerate() {
            let removed = step.loads_removed;
            active.retain(|atom, _| match atom {
                Atom::Node(..) => !removed.cload,
                Atom::Face(_) | Atom::Body(_) => !removed.dload,
                Atom::SurfaceFace(_) => !removed.dsload,
            });
            for (line, load) in step.loads.iter().enumerate() {
                let at = self.load_lines[number][line];
                let keyword = match load.kind {
                    LoadKind::Concentrated { .. } => CLOAD,
                    LoadKind::FacePressure { .. } | LoadKind::Gravity { .. } => DLOAD,
                    LoadKind::SurfacePressure { .. } => DSLOAD,
                };
                let mut seen = None;
                for atom in atoms(&load.kind) {
                    let Some(other) = active.insert(atom, (number, line)) else { continue };
                    if other == (number, line) || seen == Some(other) {
                        continue;
                    }
                    seen = Some(other);
                    let (step, earlier) = (other.0, &self.model.steps[other.0].loads[other.1]);
                    let alike = earlier.region == load.region && earlier.kind == load.kind;
                    let name = &load.region_name;
                    if step == number && alike {
                        let message = format!("the same load on {name} is given twice in one step");
                        self.report.error(at, keyword, message, "write one line with the sum");
                    } else if step == number {
                        let message = format!("the loads on {} and {name} overlap: they add", earlier.region_name);
                        self.report.warning(at, keyword, message, "check that the sum is meant");
                    } else if !alike {
                        let message = format!(
                            "the load on {name} overlaps the load on {} of an earlier step",
                            earlier.region_name
                        );
                        let remedy = "change a load under the name and in the direction it was given first, or write OP=NEW and all loads of the step";
                        self.report.error(at, keyword, message, remedy);
                    }
                }
            }
        }
    }
}

fn atoms(kind: &LoadKind) -> Vec<Atom> {
    match kind {
        LoadKind::Concentrated { nodes, direction } => {
            nodes.iter().map(|node| Atom::Node(node.0, *direction)).collect()
        }
        LoadKind::FacePressure { faces, .. } => faces.iter().copied().map(Atom::Face).collect(),
        LoadKind::SurfacePressure { faces } => faces.iter().copied().map(Atom::SurfaceFace).collect(),
        LoadKind::Gravity { elements, .. } => elements.iter().copied().map(Atom::Body).collect(),
    }
}
