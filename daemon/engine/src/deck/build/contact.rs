//! `*SURFACE INTERACTION` with its law, and `*CONTACT PAIR`.

use rustc_hash::FxHashSet;

use crate::law::{LawParameters, NormalBehavior, PressureOverclosure};
use crate::model::{
    ContactPair, Dialect, InteractionId, NodeId, PairMembers, SurfaceId, SurfaceInteraction, SurfaceKind, SurfacePair,
};

use super::super::card::Card;
use super::super::data::Row;
use super::super::keywords::Placement;
use super::super::lex::{real, unquoted};
use super::super::report::At;
use super::Builder;
use super::layout::Layout;

const INTERACTION: &str = "*SURFACE INTERACTION";
const BEHAVIOR: &str = "*SURFACE BEHAVIOR";
/// Part of a face by which a secondary node may hang over the edge of the primary surface.
const EXTENSION_ZONE: f64 = 0.1;
/// Largest EXTENSION ZONE.
const EXTENSION_ZONE_MAX: f64 = 0.2;
const PAIR: &str = "*CONTACT PAIR";

impl Builder<'_> {
    pub(super) fn build_interactions(&mut self, layout: &Layout<'_>) {
        // Whether each interaction has its *SURFACE BEHAVIOR, and the line of the interaction.
        let mut behaviors: Vec<(bool, At)> = Vec::new();
        let mut open = false;
        for card in &layout.model {
            let name = card.keyword.name;
            if name == INTERACTION {
                open = self.interaction_card(card);
                if open {
                    behaviors.push((false, card.at));
                }
            } else if !card.keyword.is_read() {
                // Reported already.
            } else if card.keyword.placement != Placement::Interaction {
                open = false;
            } else if !open {
                self.report.error(
                    card.at,
                    name,
                    "no surface interaction is being defined here",
                    "write it under *SURFACE INTERACTION",
                );
            } else if name == "*FRICTION" {
                self.friction(card);
            } else if let Some((has_behavior, _)) = behaviors.last_mut() {
                if std::mem::replace(has_behavior, true) {
                    self.report.error(
                        card.at,
                        name,
                        "the interaction has a *SURFACE BEHAVIOR already",
                        "keep one of them",
                    );
                }
                self.behavior(card, behaviors.len() as u32 - 1);
            }
        }
        if self.model.dialect == Dialect::Calculix {
            for (_, at) in behaviors.iter().filter(|(has_behavior, _)| !has_behavior) {
                let message = "no *SURFACE BEHAVIOR: contact is hard, where CalculiX would stop";
                self.report.warning(*at, INTERACTION, message, "choose a law with *SURFACE BEHAVIOR");
            }
        }
    }

    /// Begins an interaction; false when it cannot be.
    fn interaction_card(&mut self, card: &Card) -> bool {
        let Some(name) = card.parameters.value("NAME") else { return false };
        let (position, is_new) = self.interactions.enter(name, card.at);
        if !is_new {
            let message = format!("surface interaction {name} is defined twice");
            self.report.error(card.at, INTERACTION, message, "rename or remove one");
            return false;
        }
        let mut node_area = None;
        if card.first_line().is_some() {
            let row = card.single_row("area of each node of a node-based surface", self.report);
            match row.and_then(|row| row.real(0, "area per node", Some(1.0), self.report)) {
                Some(area) if area > 0.0 => node_area = Some(area),
                Some(area) => {
                    self.report.error(
                        card.at,
                        INTERACTION,
                        format!("area per node {area} is not positive"),
                        "give a positive area",
                    );
                    self.interactions.mark_faulty(position);
                }
                None => self.interactions.mark_faulty(position),
            }
        }
        if card.faulty {
            self.interactions.mark_faulty(position);
        }
        self.model
            .interactions
            .push(SurfaceInteraction { node_area, ..SurfaceInteraction::new(name, NormalBehavior::Hard) });
        true
    }

    fn friction(&mut self, card: &Card) {
        for line in card.lines().iter() {
            let row = line.row(card.keyword.name);
            match row.real(0, "friction coefficient", Some(0.0), self.report) {
                None | Some(0.0) => {}
                Some(coefficient) => {
                    let message =
                        format!("friction coefficient {coefficient} is not supported and would change the answer");
                    self.report.error(
                        row.at,
                        row.keyword,
                        message,
                        "contact is solved without friction: remove *FRICTION or write 0",
                    );
                }
            }
        }
    }

    fn behavior(&mut self, card: &Card, interaction: u32) {
        let word = card.parameters.word("PRESSURE-OVERCLOSURE");
        let softened = matches!(word.as_str(), "LINEAR" | "TABULAR" | "EXPONENTIAL");
        let mut sound = !card.faulty;
        let law_name = word.to_lowercase();
        for enforcement in ["NO SEPARATION", "AUGMENTED LAGRANGE", "PENALTY"] {
            if !card.parameters.has(enforcement) {
                continue;
            }
            sound = false;
            if softened && enforcement != "PENALTY" {
                let message = format!("the {law_name} law cannot be combined with {enforcement}");
                self.report.error(card.at, BEHAVIOR, message, "choose one of the two");
            } else {
                let message = format!("{enforcement} is not supported and would change the answer");
                self.report.error(
                    card.at,
                    BEHAVIOR,
                    message,
                    "leave it out: hard contact is enforced exactly, softened laws as they are",
                );
            }
        }
        let law = match word.as_str() {
            _ if card.faulty => None,
            "LINEAR" => self.linear(card),
            "TABULAR" => self.tabular(card),
            "EXPONENTIAL" => self.exponential(card),
            _ => {
                if let (Some(line), true) = (card.first_line(), sound) {
                    self.report.error(
                        line.at,
                        BEHAVIOR,
                        "hard contact takes no data line",
                        "remove the line, or choose a law with PRESSURE-OVERCLOSURE=",
                    );
                    sound = false;
                }
                if self.model.dialect == Dialect::Calculix {
                    let message = "hard contact is enforced exactly; CalculiX would replace it by a stiff spring";
                    self.report.warning(card.at, BEHAVIOR, message, "");
                }
                None
            }
        };
        match law.map(PressureOverclosure::try_from) {
            Some(Ok(law)) => self.model.interactions[interaction as usize].normal = NormalBehavior::Softened(law),
            Some(Err(_)) => sound = false,
            None => sound &= !softened,
        }
        if !sound {
            self.interactions.mark_faulty(interaction);
        }
    }

    fn linear(&mut self, card: &Card) -> Option<LawParameters> {
        let row = card.single_row("slope", self.report)?;
        self.extra_items(&row, 1, "the arctangent smoothing of CalculiX (σ∞, c0) is not applied: pressure is 0 when open, slope times overclosure when closed");
        let stiffness = row.real(0, "slope", None, self.report)?;
        self.checked(LawParameters::Linear { stiffness }, row.at)
    }

    fn exponential(&mut self, card: &Card) -> Option<LawParameters> {
        let row = card.single_row("clearance at zero pressure c0, pressure at zero clearance p0", self.report)?;
        let clearance = row.real(0, "clearance c0", None, self.report);
        let pressure = row.real(1, "pressure p0", None, self.report);
        match self.model.dialect {
            Dialect::Abaqus => {
                if !row.text(2).is_empty() {
                    let message = "the largest stiffness is ignored: it has a meaning in explicit analyses only";
                    self.report.warning(row.at, BEHAVIOR, message, "");
                }
                row.at_most(3, self.report);
                self.checked(
                    LawParameters::Exponential {
                        clearance_at_zero_pressure: clearance?,
                        pressure_at_zero_clearance: pressure?,
                        stiffness_max: None,
                    },
                    row.at,
                )
            }
            Dialect::Calculix => {
                self.extra_items(&row, 2, "CalculiX reads two items");
                self.checked(LawParameters::CalculixExponential { clearance: clearance?, pressure: pressure? }, row.at)
            }
        }
    }

    fn tabular(&mut self, card: &Card) -> Option<LawParameters> {
        let mut points = Vec::new();
        let mut sound = true;
        for line in card.lines().iter() {
            let row = line.row(BEHAVIOR);
            row.at_most(2, self.report);
            let pressure = row.real(0, "pressure", Some(0.0), self.report);
            let overclosure = row.real(1, "overclosure", Some(0.0), self.report);
            match (pressure, overclosure) {
                (Some(pressure), Some(overclosure)) => points.push((pressure, overclosure)),
                _ => sound = false,
            }
        }
        if !sound {
            return None;
        }
        if self.model.dialect == Dialect::Calculix {
            let message = "beyond the last point the table goes on with its last slope; CalculiX would keep the pressure constant";
            self.report.warning(card.at, BEHAVIOR, message, "end the table beyond the overclosures that occur");
        }
        self.checked(LawParameters::Tabular { points }, card.first_line().map_or(card.at, |line| line.at))
    }

    /// Items that only CalculiX knows: an error, or in its dialect a warning that says what is not done.
    fn extra_items(&mut self, row: &Row<'_>, count: usize, why: &str) {
        match self.model.dialect {
            Dialect::Abaqus => {
                if row.fields.iter().skip(count).any(|field| !field.is_empty()) {
                    let message = format!("the line has more than {}", items(count));
                    self.report.error(
                        row.at,
                        row.keyword,
                        message,
                        "remove them; a deck written for CalculiX is read with the dialect calculix",
                    );
                }
            }
            Dialect::Calculix => {
                if row.fields.iter().skip(count).any(|field| !field.is_empty()) {
                    self.report.warning(
                        row.at,
                        row.keyword,
                        format!("what stands behind {} is ignored: {why}", items(count)),
                        "",
                    );
                }
            }
        }
    }

    /// The parameters when a law can be made of them; everything that is wrong with them is reported.
    fn checked(&mut self, parameters: LawParameters, at: At) -> Option<LawParameters> {
        let violations = parameters.violations();
        for violation in &violations {
            self.report.error(at, BEHAVIOR, violation.to_string(), "correct the data line");
        }
        violations.is_empty().then_some(parameters)
    }

    pub(super) fn build_pairs(&mut self, layout: &Layout<'_>) {
        for card in layout.model.iter().filter(|card| card.keyword.name == PAIR) {
            let interaction = card.parameters.value("INTERACTION");
            let interaction = interaction.and_then(|name| self.interactions.refer(name, card.at, PAIR, self.report));
            if !card.parameters.has("SMALL SLIDING") {
                let message = "finite sliding is solved as small sliding: a point keeps the place on the primary surface that it starts from";
                self.report.warning(
                    card.at,
                    PAIR,
                    message,
                    "add SMALL SLIDING to say so; the run stops when a point slides beyond half a face",
                );
            }
            if card.parameters.word("TYPE") == "SURFACETOSURFACE" {
                let message = "surface-to-surface contact is solved node-to-surface: forces act at the secondary nodes, and where the meshes do not match a uniform pressure is not transmitted as one";
                self.report.warning(
                    card.at,
                    PAIR,
                    message,
                    "let the finer mesh be the secondary one; its resultant is right",
                );
            }
            if card.first_line().is_none() {
                self.report.error(
                    card.at,
                    PAIR,
                    "the data line is missing",
                    "write: secondary surface, primary surface",
                );
            }
            let extension_zone = self.extension_zone(card.parameters.value("EXTENSION ZONE"), card.at);
            let adjust = self.adjust_parameter(card);
            for line in card.lines().iter() {
                let row = line.row(PAIR);
                let (secondary, primary) =
                    (self.pair_surface(&row, 0, "secondary"), self.pair_surface(&row, 1, "primary"));
                if row.fields.iter().skip(2).any(|field| !field.is_empty()) {
                    self.report.warning(
                        row.at,
                        PAIR,
                        "orientations behind the surfaces are ignored: contact is frictionless",
                        "",
                    );
                }
                let (Some(secondary), Some(primary)) = (secondary, primary) else { continue };
                if self.pair_is_sound(&row, secondary, primary)
                    && let (Some(interaction), Some(extension_zone), Ok(adjust), false) =
                        (interaction, extension_zone, adjust, card.faulty)
                {
                    let place = self.map.place(row.at);
                    let interaction = InteractionId(interaction);
                    let name = self.pair_name(secondary, primary);
                    let clearances = Vec::new();
                    let members = PairMembers::Surfaces(SurfacePair {
                        secondary,
                        primary,
                        extension_zone,
                        hcrit: None,
                        adjust,
                        clearances,
                    });
                    self.push_pair(ContactPair { name, members, interaction, place }, (secondary, primary), row.at);
                }
            }
        }
    }

    fn pair_surface(&mut self, row: &Row<'_>, index: usize, role: &str) -> Option<SurfaceId> {
        let name = unquoted(row.text(index));
        if name.is_empty() {
            let remedy = if index == 1 {
                "write: secondary surface, primary surface; contact of a surface with itself is not solved"
            } else {
                "write: secondary surface, primary surface"
            };
            self.report.error(row.at, PAIR, format!("the {role} surface is missing"), remedy);
            return None;
        }
        self.surfaces.refer(name, row.at, PAIR, self.report).map(SurfaceId)
    }

    fn pair_is_sound(&mut self, row: &Row<'_>, secondary: SurfaceId, primary: SurfaceId) -> bool {
        let surfaces = &self.model.mesh.surfaces;
        let (first, second) = (&surfaces[secondary.index()], &surfaces[primary.index()]);
        if secondary == primary {
            let message = format!("surface {} is secondary and primary of the same pair", first.name);
            self.report.error(
                row.at,
                PAIR,
                message,
                "contact of a surface with itself is not solved: name two surfaces",
            );
            return false;
        }
        if let SurfaceKind::Nodes(_) = second.kind {
            let message = format!("the primary surface {} is made of nodes", second.name);
            self.report.error(row.at, PAIR, message, "define it by faces, or exchange the surfaces");
            return false;
        }
        if let SurfaceKind::Faces(faces) = &first.kind
            && let Some(face) = faces.iter().find(|&&face| self.model.mesh.face_nodes(face).is_quadratic())
        {
            let mesh = &self.model.mesh;
            let message = format!(
                "the secondary surface {} has faces with midside nodes (face S{} of element {}, {}): in node-to-surface contact their corners stand for no area or a negative one",
                first.name,
                face.face + 1,
                mesh.element_labels[face.element.index()],
                mesh.elements.kind(face.element.index()).name()
            );
            self.report.error(
                row.at,
                PAIR,
                message,
                "exchange the surfaces, mesh this body with C3D4, C3D6 or C3D8, or list the nodes with TYPE=NODE and their area",
            );
            return false;
        }
        let size = |kind: &SurfaceKind| match kind {
            SurfaceKind::Faces(faces) => faces.iter().map(|&face| self.model.mesh.face_nodes(face).len()).sum(),
            SurfaceKind::Nodes(nodes) => nodes.len(),
        };
        if !self.budget.take(size(&first.kind) + size(&second.kind), row.at, PAIR, self.report) {
            return false;
        }
        let on_primary: FxHashSet<NodeId> = self.surface_nodes(primary).into_iter().collect();
        let shared: Vec<NodeId> =
            self.surface_nodes(secondary).into_iter().filter(|node| on_primary.contains(node)).collect();
        if let Some(node) = shared.first() {
            let label = self.model.mesh.node_labels[node.index()];
            let message =
                format!("{} nodes stand on both surfaces of the pair, the first is node {label}", shared.len());
            self.report.error(
                row.at,
                PAIR,
                message,
                "give the bodies nodes of their own, or take the nodes out of the secondary surface",
            );
            return false;
        }
        true
    }

    /// Nodes of a surface, ascending.
    pub(super) fn surface_nodes(&self, surface: SurfaceId) -> Vec<NodeId> {
        let mesh = &self.model.mesh;
        let mut nodes = match &mesh.surfaces[surface.index()].kind {
            SurfaceKind::Nodes(nodes) => nodes.clone(),
            SurfaceKind::Faces(faces) => faces.iter().flat_map(|&face| mesh.face_nodes(face).to_vec()).collect(),
        };
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// EXTENSION ZONE: part of a face, 0.1 unless given, at most 0.2 as in the manual.
    fn extension_zone(&mut self, text: Option<&str>, at: At) -> Option<f64> {
        let Some(text) = text else { return Some(EXTENSION_ZONE) };
        match real(text.trim().as_bytes()) {
            Ok(zone) if (0.0..=EXTENSION_ZONE_MAX).contains(&zone) => Some(zone),
            _ => {
                let message = format!("EXTENSION ZONE={text}: not a number from 0 to {EXTENSION_ZONE_MAX}");
                self.report.error(
                    at,
                    PAIR,
                    message,
                    "give the part of a face by which the primary surface is extended",
                );
                None
            }
        }
    }

    fn pair_name(&self, secondary: SurfaceId, primary: SurfaceId) -> String {
        let name = |surface: SurfaceId| &self.model.mesh.surfaces[surface.index()].name;
        format!("{}_{}", name(secondary), name(primary))
    }

    fn push_pair(&mut self, pair: ContactPair, surfaces: (SurfaceId, SurfaceId), at: At) {
        if !self.pairs.insert(surfaces) {
            let message = format!("the pair {} is given twice", pair.name);
            self.report.error(at, PAIR, message, "remove one of the lines");
            return;
        }
        self.model.pairs.push(pair);
        self.pair_at.push(at);
    }
}

fn items(count: usize) -> String {
    match count {
        1 => "one item".into(),
        count => format!("{count} items"),
    }
}
