//! `*CONTACT CONTROLS`: what a card states, and how it adds to what earlier cards stated.

use crate::model::{ContactControls, Enforcement, FrictionOnset, ModifiedHard, PenetrationTolerance, Stabilization};

use super::super::card::Card;
use super::super::lex::{looks_numeric, real};
use super::super::report::excerpt;
use super::super::rules;
use super::Builder;

const CONTROLS: &str = "*CONTACT CONTROLS";

/// Parameters that have a meaning in explicit steps only.
const EXPLICIT: [&str; 6] =
    ["CPSET", "SCALE PENALTY", "FASTLOCALTRK", "GLOBTRKINC", "WARP CHECK PERIOD", "WARP CUT OFF"];

/// What cards have stated so far, for one pair or for all; `None`: nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct StatedControls {
    tolerance: Option<PenetrationTolerance>,
    stiffness_scale: Option<f64>,
    pub modified: Option<ModifiedHard>,
    stabilization: Option<Stabilization>,
    friction_onset: Option<FrictionOnset>,
    pub scale_penalty: Option<f64>,
}

impl StatedControls {
    /// Controls of a pair: its own win over those of all pairs, these over the defaults.
    pub fn resolve(own: &Self, all: &Self) -> ContactControls {
        let default = ContactControls::default();
        ContactControls {
            penetration_tolerance: own.tolerance.or(all.tolerance).unwrap_or(default.penetration_tolerance),
            stiffness_scale: own.stiffness_scale.or(all.stiffness_scale).unwrap_or(default.stiffness_scale),
            modified: own.modified.or(all.modified),
            stabilization: own.stabilization.or(all.stabilization),
            friction_onset: own.friction_onset.or(all.friction_onset).unwrap_or(default.friction_onset),
            scale_penalty: own.scale_penalty.or(all.scale_penalty).unwrap_or(default.scale_penalty),
        }
    }

    /// Takes over what a later card states.
    pub fn add(&mut self, later: Self) {
        self.tolerance = later.tolerance.or(self.tolerance);
        self.stiffness_scale = later.stiffness_scale.or(self.stiffness_scale);
        self.modified = later.modified.or(self.modified);
        self.stabilization = later.stabilization.or(self.stabilization);
        self.friction_onset = later.friction_onset.or(self.friction_onset);
        self.scale_penalty = later.scale_penalty.or(self.scale_penalty);
    }
}

impl Builder<'_> {
    /// What a card states, `earlier` being what held before; `None` when it is wrong, which is reported.
    pub(super) fn stated_controls(&mut self, card: &Card, earlier: &StatedControls) -> Option<StatedControls> {
        for name in EXPLICIT.into_iter().filter(|name| card.parameters.has(name)) {
            let message = format!("{name} belongs to explicit steps");
            self.report.error(card.at, CONTROLS, message, "remove it; pairs are named by SLAVE and MASTER");
        }
        let mut sound = !card.faulty;
        let mut stated = StatedControls { stabilization: self.stabilization(card, &mut sound), ..Default::default() };
        let absolute = self.control(card, "ABSOLUTE PENETRATION TOLERANCE", Least::Above, &mut sound);
        let relative = self.control(card, "RELATIVE PENETRATION TOLERANCE", Least::Above, &mut sound);
        if card.parameters.has("ABSOLUTE PENETRATION TOLERANCE")
            && card.parameters.has("RELATIVE PENETRATION TOLERANCE")
        {
            sound = false;
            self.break_rule(&rules::TWO_TOLERANCES, card.at, CONTROLS, "");
        }
        stated.tolerance =
            absolute.map(PenetrationTolerance::Absolute).or(relative.map(PenetrationTolerance::Relative));
        stated.stiffness_scale = self.control(card, "STIFFNESS SCALE FACTOR", Least::Above, &mut sound);
        stated.friction_onset = match card.parameters.word("FRICTION ONSET").as_str() {
            "IMMEDIATE" => Some(FrictionOnset::Immediate),
            "DELAYED" => Some(FrictionOnset::Delayed),
            _ => None,
        };
        stated.modified = self.modified_hard(card, earlier, &mut sound);
        for (parameter, why) in [
            ("AUTOMATIC TOLERANCES", "contact states are found exactly, without tolerances that could be chosen"),
            ("APPROACH", "bodies that nothing holds yet are brought into contact without damping"),
            ("SLIDE DISTANCE", "sliding is small, and no part of the primary surface is left out of the search"),
        ] {
            if card.parameters.has(parameter) {
                self.report.warning(card.at, CONTROLS, format!("{parameter} has no effect: {why}"), "");
            }
        }
        sound.then_some(stated)
    }

    /// `MAXCHP`, `PERRMX` and `UERRMX`. A card that gives one of them states all three: those that it leaves out are 0.
    fn modified_hard(&mut self, card: &Card, earlier: &StatedControls, sound: &mut bool) -> Option<ModifiedHard> {
        let names = ["MAXCHP", "PERRMX", "UERRMX"];
        if !names.iter().any(|name| card.parameters.has(name)) {
            return None;
        }
        if card.parameters.has("AUTOMATIC TOLERANCES") {
            *sound = false;
            self.break_rule(&rules::AUTOMATIC_AND_MODIFIED, card.at, CONTROLS, "");
        }
        if !card.parameters.has("MAXCHP") {
            *sound = false;
            self.break_rule(&rules::MODIFIED_WITHOUT_COUNT, card.at, CONTROLS, "");
        }
        let points_max = self.control(card, "MAXCHP", Least::Zero, sound).unwrap_or(0.0);
        if points_max.fract() != 0.0 || points_max > f64::from(u32::MAX) {
            *sound = false;
            let message = format!("MAXCHP={points_max} is not a whole number");
            self.report.error(
                card.at,
                CONTROLS,
                message,
                "give the number of points that may violate the hard conditions",
            );
        }
        let tension_max = self.control(card, "PERRMX", Least::Zero, sound);
        let overclosure_max = self.control(card, "UERRMX", Least::Zero, sound);
        if let Some(before) = earlier.modified {
            for (name, before, now) in
                [("PERRMX", before.tension_max, tension_max), ("UERRMX", before.overclosure_max, overclosure_max)]
            {
                if before != 0.0 && now.is_none() {
                    let message = format!(
                        "{name} was {before} before and is 0 from this step on, since the line does not give it"
                    );
                    self.report.warning(card.at, CONTROLS, message, format!("write {name}={before} to keep it"));
                }
            }
        }
        Some(ModifiedHard {
            points_max: points_max as u32,
            tension_max: tension_max.unwrap_or(0.0),
            overclosure_max: overclosure_max.unwrap_or(0.0),
            global: !card.parameters.has("MASTER"),
        })
    }

    /// `STABILIZE` with `TANGENT FRACTION` and the data line.
    fn stabilization(&mut self, card: &Card, sound: &mut bool) -> Option<Stabilization> {
        if !card.parameters.has("STABILIZE") {
            if card.parameters.has("TANGENT FRACTION") {
                *sound = false;
                let message = "TANGENT FRACTION belongs to STABILIZE, which is not given";
                let remedy = "add STABILIZE; tangential contact damping is the TANGENT FRACTION of *CONTACT DAMPING";
                self.report.error(card.at, CONTROLS, message, remedy);
            }
            if let Some(line) = card.first_line() {
                *sound = false;
                let message = "a data line is read behind STABILIZE only";
                self.report.error(line.at, CONTROLS, message, "remove the line, or add STABILIZE");
            }
            return None;
        }
        let tangent_fraction = self.tangent_fraction(card, CONTROLS, 1.0);
        let factor = match card.parameters.value("STABILIZE") {
            Some(_) => self.control(card, "STABILIZE", Least::Above, sound),
            None => Some(1.0),
        };
        let (mut coefficient, mut fraction_end, mut clearance) = (None, 0.0, None);
        if card.first_line().is_some() {
            let what = "damping coefficient, part of it that is left at the end of the step, clearance without damping";
            let row = card.single_row(what, self.report)?;
            row.at_most(3, self.report);
            let mut item = |index: usize, name: &str, is_sound: fn(f64) -> bool, range: &str| {
                if row.text(index).is_empty() {
                    return None;
                }
                let value = row.real(index, name, None, self.report);
                if let Some(value) = value.filter(|&value| !is_sound(value)) {
                    let message = format!("{name} {value} is not {range}");
                    self.report.error(row.at, CONTROLS, message, format!("correct the data line: {what}"));
                }
                *sound &= value.is_some_and(is_sound);
                value
            };
            coefficient = item(0, "damping coefficient", |x| x > 0.0, "positive");
            fraction_end =
                item(1, "part left at the end of the step", |x| (0.0..=1.0).contains(&x), "from 0 to 1").unwrap_or(0.0);
            clearance = item(2, "clearance without damping", |x| x > 0.0, "positive");
        }
        let (Some(factor), Some(tangent_fraction)) = (factor, tangent_fraction) else {
            *sound = false;
            return None;
        };
        Some(Stabilization { coefficient, factor, fraction_end, clearance, tangent_fraction })
    }

    /// Value of a parameter, if it is given; outside of its range it is reported.
    pub(super) fn control(&mut self, card: &Card, name: &str, least: Least, sound: &mut bool) -> Option<f64> {
        let text = card.parameters.value(name)?;
        let (is_sound, range): (fn(f64) -> bool, _) = match least {
            Least::Zero => (|x| x >= 0.0, "is negative"),
            Least::Above => (|x| x > 0.0, "is not positive"),
        };
        let fault = match real(text.as_bytes()) {
            Ok(value) if is_sound(value) => return Some(value),
            Ok(_) => range,
            Err(_) if looks_numeric(text.as_bytes()) => "is not a finite number",
            Err(_) => "is not a number",
        };
        *sound = false;
        let message = format!("{name}={} {fault}", excerpt(text.as_bytes()));
        let remedy = match least {
            Least::Zero => "give a number from 0 on",
            Least::Above => "give a positive number",
        };
        self.report.error(card.at, CONTROLS, message, remedy);
        None
    }

    /// Warns or complains about controls that do not fit the pairs that they are for.
    pub(super) fn check_controls(&mut self, card: &Card, stated: &StatedControls, pair: Option<usize>) {
        let of_pair = |index: usize| &self.model.interactions[self.model.pairs[index].interaction.index()];
        let chosen: Vec<usize> = match pair {
            Some(pair) => vec![pair],
            None => (0..self.model.pairs.len()).collect(),
        };
        if chosen.is_empty() {
            return;
        }
        let enforced = |is: fn(&Enforcement) -> bool| {
            chosen.iter().any(|&index| is_hard(of_pair(index)) && is(&of_pair(index).enforcement))
        };
        let augmented = enforced(|e| matches!(e, Enforcement::AugmentedLagrange(_)));
        let penalty = enforced(|e| !matches!(e, Enforcement::Lagrange));
        let multipliers = enforced(|e| matches!(e, Enforcement::Lagrange));
        let whose = if pair.is_some() { "the pair is not" } else { "no pair is" };
        if stated.tolerance.is_some() && !augmented {
            let message = format!("the penetration tolerance has no effect: {whose} enforced by AUGMENTED LAGRANGE");
            let remedy = "write AUGMENTED LAGRANGE under *SURFACE BEHAVIOR, or remove the tolerance";
            self.report.warning(card.at, CONTROLS, message, remedy);
        }
        if stated.stiffness_scale.is_some() && !penalty {
            let message = format!("STIFFNESS SCALE FACTOR has no effect: {whose} enforced by a penalty stiffness");
            let remedy = "write AUGMENTED LAGRANGE or PENALTY under *SURFACE BEHAVIOR, or remove the factor";
            self.report.warning(card.at, CONTROLS, message, remedy);
        }
        if stated.modified.is_some() && !multipliers {
            if pair.is_some() {
                self.break_rule(&rules::MODIFIED_NOT_HARD, card.at, CONTROLS, "");
            } else {
                let message =
                    "MAXCHP, PERRMX and UERRMX have no effect: no pair has hard contact enforced by multipliers";
                self.report.warning(card.at, CONTROLS, message, "remove them, or write PRESSURE-OVERCLOSURE=HARD");
            }
        }
    }
}

/// Hard contact, however it is enforced.
pub fn is_hard(interaction: &crate::model::SurfaceInteraction) -> bool {
    interaction.normal == crate::law::NormalBehavior::Hard
}

/// Where the range of a number begins.
#[derive(Clone, Copy)]
pub enum Least {
    /// 0 is in it.
    Zero,
    /// 0 is not.
    Above,
}
