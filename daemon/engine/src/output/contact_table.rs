//! `JOB_contact.csv`: one row per contact point and output time.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::{push_name, push_number};
use crate::simulation::{ContactPointResult, IncrementReport, PreparedModel};

const HEADER: &str = "step,increment,time,pair,node,status,area,COPEN,CPRESS,CSHEAR1,CSHEAR2,CSLIP1,CSLIP2\n";

pub(super) struct ContactTable {
    file: TextFile,
}

impl ContactTable {
    pub(super) fn create(directory: &Path, job: &str) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, "_contact.csv")?;
        file.append(HEADER)?;
        Ok(Self { file })
    }

    pub(super) fn rows(
        &mut self,
        prepared: &PreparedModel,
        increment: &IncrementReport,
        results: &[ContactPointResult],
    ) -> Result<(), OutputError> {
        let model = prepared.model();
        let mut when = format!("{},{}", increment.step, increment.increment);
        push_number(&mut when, increment.time);
        let mut text = String::with_capacity(200 * results.len());
        for (point, result) in prepared.contact_points().iter().zip(results) {
            text.push_str(&when);
            push_name(&mut text, &model.pairs[point.pair as usize].name);
            let label = model.mesh.node_labels[point.node.index()];
            // Writing to a string does not fail.
            let _ = write!(text, ",{label},{}", result.status.code());
            let ContactPointResult { status: _, clearance, pressure, viscous: _, shear, viscous_shear: _, slip } =
                *result;
            for value in [point.area, clearance, pressure, shear[0], shear[1], slip[0], slip[1]] {
                push_number(&mut text, value);
            }
            text.push('\n');
        }
        self.file.append(&text)
    }
}
