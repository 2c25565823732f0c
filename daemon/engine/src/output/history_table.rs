//! `JOB_history.csv`: one row per increment.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::{push_name, push_number, push_numbers};
use crate::simulation::{Energies, HistoryRow, IncrementReport, PairTotals, PreparedModel};

pub(super) struct HistoryTable {
    file: TextFile,
}

impl HistoryTable {
    pub(super) fn create(directory: &Path, job: &str, prepared: &PreparedModel) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, "_history.csv")?;
        let pairs: Vec<&str> = prepared.model().pairs.iter().map(|p| p.name.as_str()).collect();
        file.append(&header(&pairs, &prepared.total_set_names()))?;
        Ok(Self { file })
    }

    pub(super) fn row(&mut self, increment: &IncrementReport, history: &HistoryRow) -> Result<(), OutputError> {
        self.file.append(&row(increment, history))
    }
}

fn header(pairs: &[&str], sets: &[&str]) -> String {
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
    text.push('\n');
    text
}

fn row(increment: &IncrementReport, history: &HistoryRow) -> String {
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
    text.push('\n');
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_have_a_value_for_every_column() {
        let header = header(&["S_M", "A_B"], &["NTOP"]);
        assert!(
            header.starts_with("step,increment,time,dt,CFN1[S_M],CFN2[S_M],CFN3[S_M],CFNM[S_M],CAREA[S_M],CFN1[A_B]")
        );
        assert!(header.ends_with("IMPACT_LOSS,ETOTAL,RF1[NTOP],RF2[NTOP],RF3[NTOP]\n"));
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
        let row = row(&increment, &history);
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
    }
}
