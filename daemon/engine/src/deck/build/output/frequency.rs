//! When a request is due: `FREQUENCY`, `NUMBER INTERVAL`, `TIME INTERVAL`.

use crate::model::{Dialect, OutputFrequency, OutputTarget, RestartFrequency, RestartRequest};

use super::super::super::card::Card;
use super::super::super::lex;
use super::super::super::report::excerpt;
use super::super::Builder;

/// Parts of an explicit step that fields are written for, unless a request says otherwise (Abaqus/Explicit).
const EXPLICIT_INTERVALS: u32 = 20;

/// When a request without a word about it is due. Explicit steps have very many increments: their fields are written at intervals.
pub fn default_of(target: OutputTarget, explicit: bool) -> OutputFrequency {
    match target {
        OutputTarget::Field | OutputTarget::File if explicit => OutputFrequency::Intervals(EXPLICIT_INTERVALS),
        OutputTarget::Field | OutputTarget::File | OutputTarget::Print | OutputTarget::History => {
            OutputFrequency::EVERY
        }
    }
}

/// The `*RESTART, WRITE` in force.
#[derive(Clone, Copy)]
pub struct Snapshots {
    /// What the card says: increments or parts of the step; nothing.
    frequency: Option<OutputFrequency>,
    overlay: bool,
    /// Steps since the request, this one included.
    steps: u32,
}

impl Snapshots {
    /// Another step begins under the request.
    pub fn enter_step(&mut self) {
        self.steps += 1;
    }

    /// What the request means in this step: Abaqus/Standard counts increments, CalculiX counts steps, and Abaqus/Explicit, which
    /// knows no `FREQUENCY`, parts of the step.
    pub fn in_step(self, dialect: Dialect, explicit: bool) -> Option<RestartRequest> {
        let of_increments = |every: u32| match dialect {
            Dialect::Abaqus => Some(RestartFrequency::Increments(every)),
            Dialect::Calculix => self.steps.is_multiple_of(every).then_some(RestartFrequency::StepEnd),
        };
        let frequency = match self.frequency {
            Some(OutputFrequency::Increments(every)) => of_increments(every)?,
            Some(OutputFrequency::Intervals(parts)) => RestartFrequency::Intervals(parts),
            Some(OutputFrequency::TimeInterval(_)) | None if explicit => RestartFrequency::StepEnd,
            Some(OutputFrequency::TimeInterval(_)) | None => of_increments(1)?,
        };
        Some(RestartRequest { frequency, overlay: self.overlay })
    }
}

impl Builder<'_> {
    /// A `*RESTART, WRITE`; none where it ends the snapshots.
    pub(super) fn snapshots(&mut self, card: &Card) -> Option<Snapshots> {
        let frequency = self.stated_frequency(card);
        let wanted = frequency.is_none_or(|frequency| !frequency.is_never());
        wanted.then(|| Snapshots { frequency, overlay: card.parameters.has("OVERLAY"), steps: 0 })
    }

    /// When a card wants its values; none where it says nothing, or nothing that is right, which is reported.
    pub(super) fn stated_frequency(&mut self, card: &Card) -> Option<OutputFrequency> {
        let parameters = ["FREQUENCY", "NUMBER INTERVAL", "TIME INTERVAL"];
        let given: Vec<_> = parameters.iter().filter_map(|name| Some((*name, card.parameters.value(name)?))).collect();
        let (&(name, text), others) = given.split_first()?;
        let name_of_card = card.keyword.name;
        if let Some((other, _)) = others.first() {
            let message = format!("{name} and {other} exclude each other");
            self.report.error(card.at, name_of_card, message, "write one of them");
            return None;
        }
        let frequency = match name {
            "FREQUENCY" => text.parse().ok().map(OutputFrequency::Increments),
            "NUMBER INTERVAL" => text.parse().ok().filter(|&parts: &u32| parts > 0).map(OutputFrequency::Intervals),
            _ => lex::real(text.as_bytes()).ok().filter(|&time| time > 0.0).map(OutputFrequency::TimeInterval),
        };
        if frequency.is_none() {
            let (what, remedy) = match name {
                "FREQUENCY" => ("a whole number", "write every how many increments to write, 0 for never"),
                "NUMBER INTERVAL" => {
                    ("a whole number above 0", "write at the ends of how many equal parts of the step to write")
                }
                _ => ("a positive time", "write the time between two outputs"),
            };
            let message = format!("{name}={} is not {what}", excerpt(text.as_bytes()));
            self.report.error(card.at, name_of_card, message, remedy);
        }
        frequency
    }
}
