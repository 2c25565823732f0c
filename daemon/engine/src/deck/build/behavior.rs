//! `*SURFACE BEHAVIOR`: the normal behaviour of an interaction.

use crate::law::{LawParameters, NormalBehavior, PressureOverclosure, Separation};
use crate::model::{Dialect, InteractionId};

use super::super::card::Card;
use super::super::data::Row;
use super::super::facts::Law;
use super::super::lex::real;
use super::super::report::At;
use super::Builder;
use super::enforcement::AskedNormal;

const BEHAVIOR: &str = "*SURFACE BEHAVIOR";

impl Builder<'_> {
    /// Gives an interaction its normal behaviour; whether the card is sound. Combinations that the manual forbids are found later,
    /// with the procedures of the deck (`rules.rs`).
    pub(super) fn behavior(&mut self, card: &Card, id: InteractionId) -> bool {
        let word = card.parameters.word("PRESSURE-OVERCLOSURE");
        let asked = AskedNormal {
            softened: match word.as_str() {
                "LINEAR" => Some(Law::Linear),
                "TABULAR" => Some(Law::Tabular),
                "EXPONENTIAL" => Some(Law::Exponential),
                _ => None,
            },
            augmented: card.parameters.has("AUGMENTED LAGRANGE"),
            penalty: card.parameters.has("PENALTY"),
            no_separation: card.parameters.has("NO SEPARATION"),
            table_start: table_start(card),
        };
        self.interaction_lines[id.index()].asked = asked;
        if asked.no_separation {
            self.model.interactions[id.index()].separation = Separation::Prevented;
        }
        let Some(law) = asked.softened else {
            let enforcement = self.enforcement(card, asked);
            if self.model.dialect == Dialect::Calculix && asked.is_plain_hard() {
                let message = "hard contact is enforced exactly; CalculiX would replace it by a stiff spring";
                self.report.warning(card.at, BEHAVIOR, message, "");
            }
            let Some(enforcement) = enforcement else { return false };
            self.model.interactions[id.index()].enforcement = enforcement;
            return !card.faulty;
        };
        // In explicit analyses linear and tabular laws go on into tension.
        let stays = asked.no_separation && !(self.is_explicit && law != Law::Exponential);
        let beside_others = stays || asked.augmented || asked.penalty;
        if card.faulty {
            return false;
        }
        let parameters = match law {
            Law::Linear => self.linear(card),
            Law::Tabular => self.tabular(card),
            Law::Exponential => self.exponential(card),
        };
        match parameters.map(PressureOverclosure::try_from) {
            Some(Ok(law)) => {
                self.model.interactions[id.index()].normal = NormalBehavior::Softened(law);
                // What may not stand beside a law is reported with the combinations.
                !beside_others
            }
            Some(Err(_)) | None => false,
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
                row.at_most(3, self.report);
                let mut stiffness_max = None;
                if !row.text(2).is_empty() && self.is_explicit {
                    stiffness_max = Some(row.real(2, "largest stiffness", None, self.report)?);
                } else if !row.text(2).is_empty() {
                    let message = "the largest stiffness is ignored: it has a meaning in explicit analyses only";
                    self.report.warning(row.at, BEHAVIOR, message, "");
                }
                self.checked(
                    LawParameters::Exponential {
                        clearance_at_zero_pressure: clearance?,
                        pressure_at_zero_clearance: pressure?,
                        stiffness_max,
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
}

/// First point of a table, if it can be read.
fn table_start(card: &Card) -> Option<(f64, f64)> {
    let row = card.first_line().filter(|_| card.parameters.word("PRESSURE-OVERCLOSURE") == "TABULAR")?.row(BEHAVIOR);
    let item = |index| match row.text(index) {
        "" => Some(0.0),
        text => real(text.as_bytes()).ok(),
    };
    Some((item(0)?, item(1)?))
}

fn items(count: usize) -> String {
    match count {
        1 => "one item".into(),
        count => format!("{count} items"),
    }
}
