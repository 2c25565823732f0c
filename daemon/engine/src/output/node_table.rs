//! `JOB_nodes.csv`: one row per node of the requested sets and output time.

use std::fmt::Write;
use std::path::Path;

use super::file::{OutputError, TextFile};
use super::number::{push_number, push_numbers};
use crate::model::{Model, NodeId, SetId};
use crate::simulation::{IncrementReport, NodalSolution};

const HEADER: &str = "step,increment,time,node,U1,U2,U3,UR1,UR2,UR3,V1,V2,V3,A1,A2,A3,RF1,RF2,RF3,RM1,RM2,RM3\n";

pub(super) struct NodeTable {
    file: TextFile,
    /// Per node: the write in which it last got a row, so that a node of two sets gets one row. 0: never.
    written: Vec<u32>,
    write: u32,
}

impl NodeTable {
    pub(super) fn create(directory: &Path, job: &str) -> Result<Self, OutputError> {
        let mut file = TextFile::create(directory, job, "_nodes.csv")?;
        file.append(HEADER)?;
        Ok(Self { file, written: Vec::new(), write: 0 })
    }

    /// Rotations and moments are those of the reference nodes of rigid bodies; a static solution has no velocities and
    /// accelerations: empty.
    pub(super) fn rows(
        &mut self,
        model: &Model,
        increment: &IncrementReport,
        sets: &[SetId],
        solution: &NodalSolution,
    ) -> Result<(), OutputError> {
        if sets.is_empty() {
            return Ok(());
        }
        self.write += 1;
        self.written.resize(model.mesh.nodes.len(), 0);
        let mut when = format!("{},{}", increment.step, increment.increment);
        push_number(&mut when, increment.time);
        let mut text = String::new();
        for set in sets {
            for node in &model.mesh.node_sets[set.index()].nodes {
                let i = node.index();
                if std::mem::replace(&mut self.written[i], self.write) == self.write {
                    continue;
                }
                // Writing to a string does not fail.
                let _ = write!(text, "{when},{}", model.mesh.node_labels[i]);
                let turning = model.mesh.rotation_of(*node).map(NodeId::index);
                push_numbers(&mut text, &solution.displacement[i]);
                push_or_blank(&mut text, turning.map(|hidden| solution.displacement[hidden]));
                push_or_blank(&mut text, solution.velocity.get(i).copied());
                push_or_blank(&mut text, solution.acceleration.get(i).copied());
                push_numbers(&mut text, &solution.reaction[i]);
                push_or_blank(&mut text, turning.map(|hidden| solution.reaction[hidden]));
                text.push('\n');
            }
        }
        self.file.append(&text)
    }
}

/// Three numbers, or three empty fields.
fn push_or_blank(text: &mut String, values: Option<[f64; 3]>) {
    match values {
        Some(values) => push_numbers(text, &values),
        None => text.push_str(",,,"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::NodeSet;

    #[test]
    fn a_node_of_two_sets_gets_one_row_with_every_column() {
        let directory = tempfile::tempdir().unwrap();
        let mut model = Model::default();
        model.mesh.nodes = vec![[0.0; 3]; 3];
        model.mesh.node_labels = vec![10, 20, 30];
        let set = |nodes: &[u32]| NodeSet { name: "N".into(), nodes: nodes.iter().map(|&n| NodeId(n)).collect() };
        model.mesh.node_sets = vec![set(&[0, 1]), set(&[1, 2])];
        let solution = NodalSolution {
            displacement: vec![[0.5, 0.25, -1.0]; 3],
            reaction: vec![[0.0, 0.0, 8.0]; 3],
            ..NodalSolution::default()
        };
        let mut table = NodeTable::create(directory.path(), "job").unwrap();
        let increment = IncrementReport { step: 1, increment: 2, time: 0.5, ..Default::default() };
        for _ in 0..2 {
            table.rows(&model, &increment, &[SetId(0), SetId(1)], &solution).unwrap();
        }
        let text = std::fs::read_to_string(directory.path().join("job_nodes.csv")).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 7, "{text}");
        let columns: Vec<&str> = lines[0].split(',').collect();
        let fields: Vec<&str> = lines[3].split(',').collect();
        assert_eq!(fields.len(), columns.len());
        assert_eq!(&fields[..2], ["1", "2"]);
        let at = |name: &str| fields[columns.iter().position(|c| *c == name).unwrap()];
        assert_eq!((at("node"), at("U3"), at("RF3")), ("30", "-1.0000000000000000e0", "8.0000000000000000e0"));
        for absent in ["UR1", "UR3", "V1", "V3", "A1", "A3", "RM1", "RM3"] {
            assert_eq!(at(absent), "", "{absent}");
        }
    }

    #[test]
    fn a_moving_node_has_its_velocity_and_acceleration() {
        let directory = tempfile::tempdir().unwrap();
        let mut model = Model::default();
        (model.mesh.nodes, model.mesh.node_labels) = (vec![[0.0; 3]; 2], vec![10, 20]);
        model.mesh.node_sets = vec![NodeSet { name: "N".into(), nodes: vec![NodeId(1)] }];
        let solution = NodalSolution {
            displacement: vec![[0.0; 3]; 2],
            velocity: vec![[0.0; 3], [0.5, -0.0, 2.0]],
            acceleration: vec![[0.0; 3], [-4.0, 8.0, 1e-300]],
            reaction: vec![[0.0; 3]; 2],
        };
        let mut table = NodeTable::create(directory.path(), "job").unwrap();
        let increment = IncrementReport { step: 1, increment: 1, ..Default::default() };
        table.rows(&model, &increment, &[SetId(0)], &solution).unwrap();
        let text = std::fs::read_to_string(directory.path().join("job_nodes.csv")).unwrap();
        let [header, row] = text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
        let (columns, fields): (Vec<&str>, Vec<&str>) = (header.split(',').collect(), row.split(',').collect());
        assert_eq!(fields.len(), columns.len());
        let at = |name: &str| fields[columns.iter().position(|c| *c == name).unwrap()].parse::<f64>().unwrap();
        for (name, value) in [("V1", 0.5), ("V2", -0.0), ("V3", 2.0), ("A1", -4.0), ("A2", 8.0), ("A3", 1e-300)] {
            assert_eq!(at(name).to_bits(), f64::to_bits(value), "{name}");
        }
    }

    #[test]
    fn a_reference_node_has_rotations_and_moments() {
        let directory = tempfile::tempdir().unwrap();
        let mut model = Model::default();
        model.mesh.nodes = vec![[0.0; 3]; 2];
        model.mesh.node_labels = vec![10, 10];
        (model.mesh.rotations, model.mesh.hidden_nodes) = (vec![(NodeId(0), NodeId(1))], 1);
        model.mesh.node_sets = vec![NodeSet { name: "N".into(), nodes: vec![NodeId(0)] }];
        let solution = NodalSolution {
            displacement: vec![[0.0; 3], [0.0, 0.5, 0.25]],
            reaction: vec![[0.0; 3], [-4.0, 0.0, 0.0]],
            ..NodalSolution::default()
        };
        let mut table = NodeTable::create(directory.path(), "job").unwrap();
        let increment = IncrementReport { step: 1, increment: 1, ..Default::default() };
        table.rows(&model, &increment, &[SetId(0)], &solution).unwrap();
        let text = std::fs::read_to_string(directory.path().join("job_nodes.csv")).unwrap();
        let [header, row] = text.lines().collect::<Vec<_>>()[..] else { panic!("{text}") };
        let (columns, fields): (Vec<&str>, Vec<&str>) = (header.split(',').collect(), row.split(',').collect());
        assert_eq!(fields.len(), columns.len());
        let at = |name: &str| fields[columns.iter().position(|c| *c == name).unwrap()].parse::<f64>().ok();
        assert_eq!(
            [at("UR1"), at("UR2"), at("UR3"), at("RM1"), at("V1")],
            [Some(0.0), Some(0.5), Some(0.25), Some(-4.0), None]
        );
    }
}
