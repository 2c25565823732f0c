//! `JOB_history.csv`: one row per increment.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::{push_name, push_number, push_numbers};
use super::totals::{Resultants, magnitude};
use crate::model::Model;
use crate::simulation::{Energies, HistoryRow, IncrementReport, PairTotals, PreparedModel};

pub(super) struct HistoryTable {
    file: TextFile,
    /// Families of totals behind the fixed columns.
    families: Vec<&'static str>,
}

/// Families that every history has, and those that it has when a step asks for them.
const ALWAYS: [&str; 2] = ["CFS", "XN"];
const ON_REQUEST: [&str; 6] = ["CFT", "CMN", "CMS", "CMT", "XS", "XT"];

impl HistoryTable {
    pub(super) fn create(directory: &Path, job: &str, prepared: &PreparedModel) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, "_history.csv")?;
        let pairs: Vec<&str> = prepared.model().pairs.iter().map(|p| p.name.as_str()).collect();
        let families = families(prepared.model());
        file.append(&header(&pairs, &prepared.total_set_names(), &families))?;
        Ok(Self { file, families })
    }

    pub(super) fn row(
        &mut self,
        increment: &IncrementReport,
        history: &HistoryRow,
        resultants: &[Resultants],
    ) -> Result<(), OutputError> {
        self.file.append(&row(increment, history, resultants, &self.families))
    }
}

/// Families of the columns of a model, in their order.
fn families(model: &Model) -> Vec<&'static str> {
    let requests = || model.steps.iter().flat_map(|step| &step.output.contacts);
    let asked = ON_REQUEST.into_iter().filter(|family| requests().any(|request| request.asks_for(&[family])));
    ALWAYS.into_iter().chain(asked).collect()
}

fn header(pairs: &[&str], sets: &[&str], families: &[&str]) -> String {
    let mut text = String::from("step,increment,time,dt");
    for pair in pairs {
        for quantity in ["CFN1", "CFN2", "CFN3", "CFNM", "CAREA"] {
            push_name(&mut text, &format!("{quantity}[{pair}]"));
        }
    }
    text.push_str(",ALLSE,ALLKE,ALLWK,ALLFD,ALLVD,ALLCCE,IMPACT_LOSS,ETOTAL");
    for set in sets {
        for quantity in ["RF1", "RF2", "RF3"] {
            push_name(&mut text, &format!("{quantity}[{set}]"));
        }
    }
    for pair in pairs {
        for family in families {
            for end in ["1", "2", "3", "M"].into_iter().filter(|end| *end != "M" || has_magnitude(family)) {
                push_name(&mut text, &format!("{family}{end}[{pair}]"));
            }
        }
    }
    text.push('\n');
    text
}

/// Forces and moments have one; centres do not, and neither does the force of friction, whose columns are fixed.
fn has_magnitude(family: &str) -> bool {
    family.starts_with('C') && family != "CFS"
}

fn row(
    increment: &IncrementReport,
    history: &HistoryRow,
    resultants: &[Resultants],
    families: &[&'static str],
) -> String {
    let mut text = String::new();
    // Writing to a string does not fail.
    let _ = write!(text, "{},{}", increment.step, increment.increment);
    push_numbers(&mut text, &[increment.time, increment.increment_size]);
    for PairTotals { force, force_magnitude, area, .. } in &history.pairs {
        push_numbers(&mut text, force);
        push_number(&mut text, *force_magnitude);
        push_number(&mut text, *area);
    }
    let Energies { strain, kinetic, external_work, friction, viscous, contact, impact_loss, total } = history.energies;
    push_numbers(&mut text, &[strain, kinetic, external_work, friction, viscous, contact, impact_loss, total]);
    for reaction in &history.reactions {
        push_numbers(&mut text, reaction);
    }
    for pair in resultants {
        for family in families {
            let vector = pair.family(family).unwrap_or_default();
            push_numbers(&mut text, &vector);
            if has_magnitude(family) {
                push_number(&mut text, magnitude(vector));
            }
        }
    }
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_a_value_for_every_column() {
        let families = ["CFS", "XN", "CMT"];
        let header = header(&["S_M", "A_B"], &["NTOP"], &families);
        assert!(
            header.starts_with("step,increment,time,dt,CFN1[S_M],CFN2[S_M],CFN3[S_M],CFNM[S_M],CAREA[S_M],CFN1[A_B]")
        );
        assert!(
            header
                .contains(",IMPACT_LOSS,ETOTAL,RF1[NTOP],RF2[NTOP],RF3[NTOP],CFS1[S_M],CFS2[S_M],CFS3[S_M],XN1[S_M],")
        );
        assert!(header.ends_with(",XN3[A_B],CMT1[A_B],CMT2[A_B],CMT3[A_B],CMTM[A_B]\n"), "{header}");
        let energies = Energies { contact: 6.0, total: 8.0, ..Default::default() };
        let history = HistoryRow {
            pairs: vec![
                PairTotals { force: [1.0, 2.0, 3.0], force_magnitude: 4.0, area: 5.0, ..Default::default() };
                2
            ],
            energies,
            reactions: vec![[7.0, 8.0, 9.0]],
        };
        let increment =
            IncrementReport { step: 2, increment: 3, time: 1.5, increment_size: 0.25, ..Default::default() };
        let force = [[1.0, 2.0, 3.0], [-1.0, 0.5, 0.0], [0.0; 3]];
        let moment = [[0.0; 3], [0.0; 3], [3.0, 0.0, 4.0]];
        let pair = Resultants { force, moment, centre: [[0.1, 0.2, 0.3]; 3], area: 5.0 };
        let row = row(&increment, &history, &[pair; 2], &families);
        let columns: Vec<&str> = header.trim_end().split(',').collect();
        let values: Vec<f64> = row.trim_end().split(',').map(|v| v.parse().unwrap()).collect();
        assert_eq!(columns.len(), values.len());
        let value = |name: &str| values[columns.iter().position(|c| *c == name).unwrap()];
        assert_eq!(value("time"), 1.5);
        assert_eq!(value("dt"), 0.25);
        assert_eq!(value("CFNM[A_B]"), 4.0);
        assert_eq!(value("ALLCCE"), 6.0);
        assert_eq!(value("ETOTAL"), 8.0);
        assert_eq!(value("RF3[NTOP]"), 9.0);
        assert_eq!(
            (value("CFS2[A_B]"), value("XN3[S_M]"), value("CMT3[A_B]"), value("CMTM[A_B]")),
            (0.5, 0.3, 4.0, 5.0)
        );
    }
}
