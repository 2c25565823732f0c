//! `*CONTACT PAIR`.

use rustc_hash::FxHashSet;

use crate::model::{ContactPair, NodeId, PairMembers, SurfaceId, SurfaceKind, SurfacePair};

use super::super::card::Card;
use super::super::data::Row;
use super::super::lex::{key, real, unquoted};
use super::super::report::At;
use super::Builder;
use super::layout::Layout;

const PAIR: &str = "*CONTACT PAIR";
/// Part of a face by which a secondary node may hang over the edge of the primary surface.
pub const EXTENSION_ZONE: f64 = 0.1;
/// Largest EXTENSION ZONE.
const EXTENSION_ZONE_MAX: f64 = 0.2;

impl Builder<'_> {
    pub(super) fn build_pairs(&mut self, layout: &Layout<'_>) {
        for (step, card) in layout.with_explicit_steps().filter(|(_, card)| card.keyword.name == PAIR) {
            if layout.is_explicit() {
                self.explicit_pair_card(step, card);
                continue;
            }
            for name in ["MECHANICAL CONSTRAINT", "WEIGHT"].into_iter().filter(|name| card.parameters.has(name)) {
                let message = format!("{name} belongs to pairs of explicit analyses");
                self.report.error(card.at, PAIR, message, "remove it, or write *DYNAMIC, EXPLICIT in every step");
            }
            if card.parameters.has("OP") {
                let remedy = "remove it; switch pairs on and off with *MODEL CHANGE, TYPE=CONTACT PAIR";
                self.report.error(card.at, PAIR, "OP belongs to pairs of explicit analyses", remedy);
            }
            let interaction = card.parameters.value("INTERACTION");
            if interaction.is_none() && !card.faulty {
                let remedy = "write *CONTACT PAIR, INTERACTION=…";
                self.report.error(card.at, PAIR, "parameter INTERACTION is missing", remedy);
            }
            let interaction = interaction.and_then(|name| self.refer_interaction(name, card.at, PAIR));
            self.warn_of_sliding(card);
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
            let hcrit = self.hcrit(card.parameters.value("HCRIT"), card.at);
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
                if self.pair_is_sound(&row, secondary, primary, 1.0)
                    && let (Some(interaction), Some(extension_zone), Ok(adjust), Ok(hcrit), false) =
                        (interaction, extension_zone, adjust, hcrit, card.faulty)
                {
                    let place = self.map.place(row.at);
                    let name = self.pair_name(secondary, primary);
                    let clearances = Vec::new();
                    let members = PairMembers::Surfaces(SurfacePair {
                        secondary,
                        primary,
                        extension_zone,
                        hcrit,
                        adjust,
                        clearances,
                    });
                    if !card.parameters.has("SMALL SLIDING") {
                        self.finite_sliding.insert(self.model.pairs.len());
                    }
                    self.push_pair(
                        ContactPair { name, members, interaction, explicit: Default::default(), place },
                        row.at,
                    );
                } else {
                    self.faulty_pairs.insert((secondary, primary));
                }
            }
        }
    }

    pub(super) fn warn_of_sliding(&mut self, card: &Card) {
        if !card.parameters.has("SMALL SLIDING") {
            let message = "finite sliding is solved as small sliding: a point keeps the place on the primary surface that it starts from";
            let remedy = "add SMALL SLIDING to say so; the run stops when a point slides beyond half a face";
            self.report.warning(card.at, PAIR, message, remedy);
        }
    }

    pub(super) fn pair_surface(&mut self, row: &Row<'_>, index: usize, role: &str) -> Option<SurfaceId> {
        let name = unquoted(row.text(index));
        if name.is_empty() {
            let remedy = match (role, index) {
                ("secondary", _) => "write: secondary surface, primary surface",
                ("primary", _) => {
                    "write: secondary surface, primary surface; contact of a surface with itself is not solved"
                }
                (_, 0) => "write: first surface, second surface",
                _ => "write: first surface, second surface; contact of a surface with itself is not solved",
            };
            self.report.error(row.at, PAIR, format!("the {role} surface is missing"), remedy);
            return None;
        }
        self.surfaces.refer(name, row.at, PAIR, self.report).map(SurfaceId)
    }

    /// Whether two surfaces can be a pair in which they have these parts for a share of the result, and the others for the rest.
    pub(super) fn pair_is_sound(
        &mut self,
        row: &Row<'_>,
        secondary: SurfaceId,
        primary: SurfaceId,
        weight: f64,
    ) -> bool {
        let fit = (weight == 0.0 || self.parts_fit(row, secondary, primary))
            && (weight == 1.0 || self.parts_fit(row, primary, secondary));
        fit && self.nodes_are_apart(row, secondary, primary)
    }

    /// Whether two surfaces can have these parts.
    fn parts_fit(&mut self, row: &Row<'_>, secondary: SurfaceId, primary: SurfaceId) -> bool {
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
        if let SurfaceKind::Bars(_) = second.kind {
            let message = format!("the primary surface {} is made of bars, which have no faces", second.name);
            self.report.error(row.at, PAIR, message, "exchange the surfaces: bars can be secondary");
            return false;
        }
        if let SurfaceKind::Analytical(_) = first.kind {
            let message = format!("the secondary surface {} is analytical: it has no nodes", first.name);
            self.report.error(row.at, PAIR, message, "exchange the surfaces: analytical surfaces are primary");
            return false;
        }
        if let SurfaceKind::Analytical(index) = second.kind
            && self.model.mesh.analytical[index as usize].body.is_none()
        {
            let message = format!("the analytical surface {} belongs to no rigid body", second.name);
            let remedy = "add *RIGID BODY, ANALYTICAL SURFACE=…, REF NODE=…";
            self.report.error(row.at, PAIR, message, remedy);
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
        true
    }

    /// Whether two surfaces have no node in common.
    fn nodes_are_apart(&mut self, row: &Row<'_>, secondary: SurfaceId, primary: SurfaceId) -> bool {
        let surfaces = &self.model.mesh.surfaces;
        let (first, second) = (&surfaces[secondary.index()], &surfaces[primary.index()]);
        let size = |kind: &SurfaceKind| match kind {
            SurfaceKind::Faces(faces) => faces.iter().map(|&face| self.model.mesh.face_nodes(face).len()).sum(),
            SurfaceKind::Nodes(nodes) => nodes.len(),
            SurfaceKind::Bars(bars) => 2 * bars.len(),
            SurfaceKind::Analytical(index) => self.model.mesh.analytical[*index as usize].segments.len(),
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
            SurfaceKind::Bars(bars) => bars.iter().flat_map(|bar| mesh.elements.nodes(bar.index())).copied().collect(),
            SurfaceKind::Analytical(index) => {
                let body = mesh.analytical[*index as usize].body;
                body.map(|body| self.model.rigid_bodies[body as usize].reference).into_iter().collect()
            }
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

    /// HCRIT: a positive length; `Err` when it is not, which is reported.
    fn hcrit(&mut self, text: Option<&str>, at: At) -> Result<Option<f64>, ()> {
        let Some(text) = text else { return Ok(None) };
        match real(text.as_bytes()) {
            Ok(length) if length > 0.0 => {
                let message =
                    "HCRIT has no effect on the answer: no increment is given up because of a deep overclosure";
                self.report.warning(at, PAIR, message, "");
                Ok(Some(length))
            }
            _ => {
                let message = format!("HCRIT={text}: not a positive length");
                self.report.error(at, PAIR, message, "give the overclosure beyond which an increment is not accepted");
                Err(())
            }
        }
    }

    pub(super) fn pair_name(&self, secondary: SurfaceId, primary: SurfaceId) -> String {
        let name = |surface: SurfaceId| &self.model.mesh.surfaces[surface.index()].name;
        format!("{}_{}", name(secondary), name(primary))
    }

    /// Adds a pair to the model, unless there is one of this name, which is reported.
    pub(super) fn push_pair(&mut self, pair: ContactPair, at: At) {
        if !self.pairs.insert(key(&pair.name)) {
            let message = format!("the pair {} is given twice", pair.name);
            self.report.error(at, self.pair_keyword(&pair), message, "remove one of the lines");
            return;
        }
        self.model.pairs.push(pair);
        self.pair_at.push(at);
    }

    fn pair_keyword(&self, pair: &ContactPair) -> &'static str {
        match pair.members {
            PairMembers::Surfaces(_) => PAIR,
            PairMembers::General(_) => "*CONTACT",
            PairMembers::Gaps(_) => self.interaction_lines[pair.interaction.index()].keyword,
        }
    }
}
