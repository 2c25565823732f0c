//! `*MATERIAL`, `*ELASTIC`, `*DENSITY`, `*DAMPING` and `*AMPLITUDE`.

use crate::model::{Amplitude, AmplitudeClock, ElementId, Material, Rayleigh};

use super::super::card::Card;
use super::super::keywords::Placement;
use super::super::lex::real;
use super::super::report::{At, Report, excerpt};
use super::Builder;
use super::layout::{Layout, is_refused};

const MATERIAL: &str = "*MATERIAL";
const AMPLITUDE: &str = "*AMPLITUDE";

/// A material that is being read.
struct Draft {
    name: String,
    at: At,
    /// Modulus and ratio; the inner value is missing when they were given but bad.
    elastic: Option<Option<(f64, f64)>>,
    density: Option<f64>,
    damping: Rayleigh,
    /// A `*DENSITY` was given, good or bad.
    has_density: bool,
    /// A keyword that describes the material was refused.
    refused: bool,
}

impl Builder<'_> {
    pub(super) fn build_materials(&mut self, layout: &Layout<'_>) {
        let mut drafts: Vec<Draft> = Vec::new();
        let mut open = false;
        for card in &layout.model {
            match card.keyword.name {
                MATERIAL => {
                    open = false;
                    let Some(name) = card.parameters.value("NAME") else { continue };
                    if self.materials.enter(name, card.at).1 {
                        drafts.push(Draft {
                            name: name.into(),
                            at: card.at,
                            elastic: None,
                            density: None,
                            damping: Rayleigh::default(),
                            has_density: false,
                            refused: false,
                        });
                        open = true;
                    } else {
                        self.report.error(
                            card.at,
                            MATERIAL,
                            format!("material {name} is defined twice"),
                            "rename or remove one",
                        );
                    }
                }
                name if card.keyword.placement == Placement::Material => match drafts.last_mut().filter(|_| open) {
                    Some(draft) => draft.add(card, self.report),
                    None => self.report.error(
                        card.at,
                        name,
                        "no material is being defined here",
                        "write it under *MATERIAL",
                    ),
                },
                _ if card.keyword.is_read() => open = false,
                _ => {
                    if let Some(draft) = drafts.last_mut().filter(|_| open && is_refused(card)) {
                        draft.refused = true;
                    }
                }
            }
        }
        for (position, draft) in (0..).zip(drafts) {
            let complete = draft.elastic.flatten();
            if draft.elastic.is_none() && !draft.refused {
                let message = format!("material {} has no *ELASTIC", draft.name);
                self.report.error(draft.at, MATERIAL, message, "add *ELASTIC with Young's modulus and Poisson's ratio");
            }
            if complete.is_none() || (draft.has_density && draft.density.is_none()) {
                self.materials.mark_faulty(position);
            }
            let (youngs_modulus, poissons_ratio) = complete.unwrap_or((1.0, 0.0));
            self.model.materials.push(Material {
                damping: draft.damping,
                name: draft.name,
                youngs_modulus,
                poissons_ratio,
                density: draft.density,
            });
        }
    }

    /// Elements need mass in dynamic steps: their materials need densities. Damping needs a dynamic step.
    pub(super) fn check_masses(&mut self, layout: &Layout<'_>) {
        if !layout.has_dynamics() {
            for card in layout.model.iter().filter(|card| card.keyword.name == "*DAMPING" || is_damped(card)) {
                let message = "damping has no effect in a static step";
                self.report.warning(card.at, card.keyword.name, message, "");
            }
            return;
        }
        let mesh = &self.model.mesh;
        let mut first_of: Vec<Option<(ElementId, usize)>> = vec![None; self.model.materials.len()];
        for (element, material) in (0..).map(ElementId).zip(&mesh.element_materials) {
            // Solids of rigid bodies have copies without stiffness: what has no density there has no mass.
            let needs = |material: &Material| material.density.is_none() && material.youngs_modulus > 0.0;
            if self.model.materials.get(material.index()).is_some_and(needs) {
                first_of[material.index()].get_or_insert((element, 0)).1 += 1;
            }
        }
        for (position, (element, count)) in (0..).zip(first_of).filter_map(|(p, first)| Some((p, first?))) {
            if self.materials.is_faulty(position) {
                continue;
            }
            let label = mesh.element_labels[element.index()];
            let message = format!(
                "material {} has no density, and {count} elements of it need mass in a dynamic step, the first is element {label}",
                self.materials.written(position)
            );
            self.report.error(self.materials.at(position), MATERIAL, message, "add *DENSITY to the material");
        }
    }

    pub(super) fn build_amplitudes(&mut self, layout: &Layout<'_>) {
        for card in layout.all.iter().filter(|card| card.keyword.name == AMPLITUDE) {
            let Some(name) = card.parameters.value("NAME") else { continue };
            let (position, is_new) = self.amplitudes.enter(name, card.at);
            if !is_new {
                self.report.error(
                    card.at,
                    AMPLITUDE,
                    format!("amplitude {name} is defined twice"),
                    "rename or remove one",
                );
                continue;
            }
            let points = amplitude_points(card, self.report);
            let points = points.filter(|_| !card.faulty).unwrap_or_else(|| {
                self.amplitudes.mark_faulty(position);
                Vec::new()
            });
            let clock = match card.parameters.word("TIME").as_str() {
                "TOTALTIME" | "TOTAL" => AmplitudeClock::Total,
                _ => AmplitudeClock::Step,
            };
            self.model.amplitudes.push(Amplitude { name: name.to_string(), clock, points });
        }
    }
}

fn is_damped(card: &Card) -> bool {
    matches!(card.keyword.name, "*MASS" | "*ROTARY INERTIA") && card.parameters.has("ALPHA")
}

impl Draft {
    fn add(&mut self, card: &Card, report: &mut Report) {
        let name = card.keyword.name;
        if name == "*DAMPING" {
            self.damping = rayleigh(card, report);
            return;
        }
        if name == "*DENSITY" {
            self.has_density = true;
            let what = "density";
            let value = card.single_row(what, report).and_then(|row| row.real(0, "density", None, report));
            match value {
                Some(density) if density > 0.0 => self.density = Some(density),
                Some(density) => report.error(
                    card.at,
                    name,
                    format!("density {density} is not positive"),
                    "give the mass per volume",
                ),
                None => {}
            }
            return;
        }
        if self.elastic.is_some() {
            report.error(card.at, name, format!("material {} has *ELASTIC already", self.name), "keep one of them");
        }
        self.elastic = Some(None);
        if card.faulty {
            return;
        }
        let Some(row) = card.single_row("Young's modulus, Poisson's ratio", report) else { return };
        let modulus = row.real(0, "Young's modulus", None, report);
        let ratio = row.real(1, "Poisson's ratio", None, report);
        let (Some(modulus), Some(ratio)) = (modulus, ratio) else { return };
        if modulus <= 0.0 {
            report.error(row.at, name, format!("Young's modulus {modulus} is not positive"), "give a positive modulus");
        }
        if ratio <= -1.0 || ratio >= 0.5 {
            let message = format!("Poisson's ratio {ratio} is not between -1 and 0.5");
            report.error(row.at, name, message, "give a ratio above -1 and below 0.5");
        }
        self.elastic = Some(Some((modulus, ratio)));
    }
}

/// `*DAMPING`: factors of mass and stiffness.
fn rayleigh(card: &Card, report: &mut Report) -> Rayleigh {
    const DAMPING: &str = "*DAMPING";
    if let Some(line) = card.first_line() {
        report.error(line.at, DAMPING, "the factors are parameters: no data line is read", "write ALPHA= and BETA=");
    }
    if !card.faulty && !card.parameters.has("ALPHA") && !card.parameters.has("BETA") {
        report.error(card.at, DAMPING, "neither ALPHA nor BETA is given", "give one of them, or both");
    }
    let mut factor = |name| not_negative(card, name, report).unwrap_or(0.0);
    Rayleigh { alpha: factor("ALPHA"), beta: factor("BETA") }
}

/// Value of a parameter that is given, when it is a number from 0 on; otherwise it is reported.
pub fn not_negative(card: &Card, name: &str, report: &mut Report) -> Option<f64> {
    let text = card.parameters.value(name)?;
    match real(text.as_bytes()) {
        Ok(value) if value >= 0.0 => Some(value),
        _ => {
            let message = format!("{name}={} is not a number from 0 on", excerpt(text.as_bytes()));
            report.error(card.at, card.keyword.name, message, "give 0 for no damping, or a positive number");
            None
        }
    }
}

fn amplitude_points(card: &Card, report: &mut Report) -> Option<Vec<(f64, f64)>> {
    let smooth = card.parameters.value("SMOOTH").filter(|smooth| real(smooth.as_bytes()) != Ok(0.0));
    if let Some(smooth) = smooth {
        let message = format!("SMOOTH={} is not supported and would change the answer", excerpt(smooth.as_bytes()));
        report.error(card.at, AMPLITUDE, message, "leave it out: the curve is straight between its points");
        return None;
    }
    let mut points: Vec<(f64, f64)> = Vec::new();
    for line in card.lines().iter() {
        let mut row = line.row(AMPLITUDE);
        while row.fields.last().is_some_and(|field| field.is_empty()) {
            row.fields.pop();
        }
        if row.fields.len() % 2 != 0 {
            report.error(row.at, AMPLITUDE, "the last time has no value", "write pairs: time, value, time, value, …");
            return None;
        }
        for i in (0..row.fields.len()).step_by(2) {
            let time = row.real(i, "time", None, report)?;
            let value = row.real(i + 1, "value", None, report)?;
            if let Some(&(before, _)) = points.last().filter(|&&(before, _)| time <= before) {
                let message = format!("time {time} does not exceed the time before, {before}");
                report.error(row.at, AMPLITUDE, message, "times must increase from pair to pair");
                return None;
            }
            points.push((time, value));
        }
    }
    if points.is_empty() {
        report.error(card.at, AMPLITUDE, "the curve has no points", "write pairs: time, value, time, value, …");
        return None;
    }
    Some(points)
}
