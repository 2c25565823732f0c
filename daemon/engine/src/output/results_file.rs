//! `JOB.fil`: the ASCII results file, for decks that ask for one (`*NODE FILE`, `*EL FILE`, `*CONTACT FILE`).

use std::fs;
use std::io;
use std::path::Path;

use super::components::{COMPONENTS, values};
use super::fil_record::{Record, Stream};
use super::file::{OutputError, TextFile};
use super::plan::Plan;
use super::printed_contact::{gap_values, points_of};
use super::results_header::{Labels, header};
use super::totals::magnitude;
use super::{Increment, NodalFields, step_of};
use crate::model::{
    ContactRequest, ElementId, ElementKind, ElementRequest, Mesh, Model, NodeId, NodeRequest, OutputTarget,
    PairMembers, Procedure, SurfaceId,
};
use crate::simulation::IncrementReport;

/// Records of the totals of a pair.
const TOTALS: [(&str, u32); 9] = [
    ("CFN", 1522),
    ("CFS", 1523),
    ("CMN", 1526),
    ("CMS", 1527),
    ("XN", 1573),
    ("XS", 1574),
    ("CFT", 1575),
    ("CMT", 1576),
    ("XT", 1577),
];
const AREA: u32 = 1524;

/// Where the values of an element record stand (attribute 4 of record 1).
#[derive(Clone, Copy)]
enum Location {
    IntegrationPoint = 0,
    AveragedAtNode = 4,
}

/// Writes the results file; nothing in a job that does not ask for one.
pub(super) struct ResultsFile {
    open: Option<Open>,
}

struct Open {
    file: TextFile,
    labels: Labels,
    stream: Stream,
}

impl ResultsFile {
    /// Removes the file of an earlier run; creates one and writes its head if a step of the model asks for it.
    pub(super) fn create(directory: &Path, job: &str, model: &Model) -> Result<Self, OutputError> {
        let path = directory.join(format!("{job}.fil"));
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => return Err(OutputError { path, source }),
            Ok(()) | Err(_) => {}
        }
        let file = |target: OutputTarget| target == OutputTarget::File;
        let is_wanted = model.steps.iter().map(|step| &step.output).any(|output| {
            output.nodes.iter().any(|r| file(r.target))
                || output.elements.iter().any(|r| file(r.target))
                || output.contacts.iter().any(|r| file(r.target))
        });
        if !is_wanted {
            return Ok(Self { open: None });
        }
        let labels = Labels::of(model);
        let mut stream = Stream::default();
        header(&mut stream, model, &labels);
        let mut file = TextFile::create(directory, job, ".fil")?;
        file.append(&stream.take())?;
        Ok(Self { open: Some(Open { file, labels, stream }) })
    }

    /// Writes what the requests of the step make due.
    pub(super) fn write(&mut self, increment: &Increment<'_>, plan: &Plan<'_>) -> Result<(), OutputError> {
        let due = !(plan.node_files.is_empty() && plan.element_files.is_empty() && plan.contact_files.is_empty());
        let Some(open) = self.open.as_mut().filter(|_| due) else { return Ok(()) };
        let model = increment.prepared.model();
        open.stream.push(&start(model, increment.report));
        if let Some(fields) = increment.fields {
            for request in &plan.element_files {
                open.elements(increment, request, fields);
            }
            for request in &plan.node_files {
                open.nodes(model, request, fields);
            }
        }
        for request in &plan.contact_files {
            open.contact(increment, request);
        }
        open.stream.end_increment();
        open.file.append(&open.stream.take())
    }
}

/// Record 2000.
fn start(model: &Model, report: &IncrementReport) -> Record {
    let procedure = match step_of(model, report).map(|step| &step.procedure) {
        // Static with automatic, or with fixed increments.
        Some(Procedure::Static(control)) if control.direct => 2,
        Some(Procedure::Static(_)) | None => 1,
        Some(Procedure::Dynamic(control)) if control.direct => 12,
        Some(Procedure::Dynamic(_)) => 11,
        Some(Procedure::Explicit(_)) => 17,
    };
    Record::new(2000)
        .reals(&[report.time, report.step_time, 0.0, 0.0])
        .wholes([procedure, report.step, report.increment, 0])
        .reals(&[0.0, 0.0, report.increment_size])
        .text("", 10)
}

/// Record 1: node or element, point, place, and the number of direct and shear components that follow.
fn element_head(label: u32, point: u32, location: Location, direct: u32, shear: u32) -> Record {
    Record::new(1).wholes([label, point, 0, location as u32]).word("").wholes([direct, shear, 0, 0])
}

impl Open {
    /// Record 1911, for elements (0, with their type) or nodes (1).
    fn request(&mut self, flag: u32, set: Option<&str>, kind: Option<&str>) {
        let set = set.map(|name| self.labels.word(name)).unwrap_or_default();
        let record = Record::new(1911).whole(flag).word(&set);
        self.stream.push(&match kind {
            Some(kind) => record.word(kind),
            None => record,
        });
    }

    fn nodes(&mut self, model: &Model, request: &NodeRequest, fields: &NodalFields) {
        let mesh = &model.mesh;
        let set = request.set.map(|set| &mesh.node_sets[set.index()]);
        self.request(1, set.map(|set| set.name.as_str()), None);
        let everything: Vec<NodeId>;
        let nodes = match set {
            Some(set) => &set.nodes,
            None => {
                everything = (0..mesh.node_count() as u32).map(NodeId).collect();
                &everything
            }
        };
        let solution = &fields.solution;
        for (key, names, values) in [
            (101, ["U", "UR"], &solution.displacement),
            (102, ["V", "VR"], &solution.velocity),
            (103, ["A", "AR"], &solution.acceleration),
            (104, ["RF", "RM"], &solution.reaction),
        ] {
            // A static step has no velocities and accelerations.
            let wanted = request.variables.iter().any(|variable| names.contains(&variable.as_str()));
            if !wanted || values.is_empty() {
                continue;
            }
            for &node in nodes {
                let record = Record::new(key).whole(mesh.node_labels[node.index()]).reals(&values[node.index()]);
                self.stream.push(&match mesh.rotation_of(node) {
                    Some(rotation) => record.reals(&values[rotation.index()]),
                    None => record,
                });
            }
        }
    }

    fn elements(&mut self, increment: &Increment<'_>, request: &ElementRequest, fields: &NodalFields) {
        let mesh = &increment.prepared.model().mesh;
        let set = request.set.map(|set| &mesh.element_sets[set.index()]);
        let name = set.map(|set| set.name.as_str());
        let is_member = |element: ElementId| set.is_none_or(|set| set.elements.binary_search(&element).is_ok());
        if request.variables.iter().any(|variable| variable == "S") {
            self.solids(mesh, name, is_member, fields);
            self.axial(mesh, name, is_member, fields);
        }
        self.gaps(increment, request, name, is_member);
    }

    /// Stresses averaged at the nodes of the solids of a request.
    fn solids(&mut self, mesh: &Mesh, set: Option<&str>, is_member: impl Fn(ElementId) -> bool, fields: &NodalFields) {
        let (mut nodes, mut kinds): (Vec<NodeId>, Vec<&str>) = Default::default();
        for (element, (kind, members)) in (0..).map(ElementId).zip(mesh.elements.iter()) {
            if kind.is_solid() && is_member(element) {
                nodes.extend(members);
                kinds.push(kind.name());
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        kinds.sort_unstable();
        kinds.dedup();
        if nodes.is_empty() {
            return;
        }
        self.request(0, set, Some(if let [kind] = kinds[..] { kind } else { "" }));
        for node in nodes {
            let label = mesh.node_labels[node.index()];
            self.stream.push(&element_head(label, 0, Location::AveragedAtNode, 3, 3));
            self.stream.push(&Record::new(11).reals(&fields.stress[node.index()]));
        }
    }

    /// The stress of bars and the force of springs, as S11.
    fn axial(&mut self, mesh: &Mesh, set: Option<&str>, is_member: impl Fn(ElementId) -> bool, fields: &NodalFields) {
        for wanted in ElementKind::CONNECTORS {
            let kind = |element: ElementId| mesh.elements.kind(element.index());
            let rows = fields.axial.iter().filter(|(element, _)| kind(*element) == wanted && is_member(*element));
            for (i, &(element, value)) in rows.enumerate() {
                if i == 0 {
                    self.request(0, set, Some(wanted.name()));
                }
                let label = mesh.element_labels[element.index()];
                self.stream.push(&element_head(label, 1, Location::IntegrationPoint, 1, 0));
                self.stream.push(&Record::new(11).reals(&[value]));
            }
        }
    }

    /// Contact elements: S11 is the pressure or force, E11 the opening, then the tangential ones.
    fn gaps(
        &mut self,
        increment: &Increment<'_>,
        request: &ElementRequest,
        set: Option<&str>,
        is_member: impl Fn(ElementId) -> bool,
    ) {
        let (prepared, mesh) = (increment.prepared, &increment.prepared.model().mesh);
        let points = || prepared.contact_points().iter().zip(increment.contact);
        for (i, pair) in prepared.model().pairs.iter().enumerate() {
            let PairMembers::Gaps(gaps) = &pair.members else { continue };
            let rows = gaps.iter().zip(points().filter(|(point, _)| point.pair as usize == i));
            let rows: Vec<_> = rows.filter(|(gap, _)| is_member(gap.element)).collect();
            let Some((first, _)) = rows.first() else { continue };
            self.request(0, set, Some(mesh.elements.kind(first.element.index()).name()));
            for (gap, (_, result)) in rows {
                let values = gap_values(result);
                let label = mesh.element_labels[gap.element.index()];
                self.stream.push(&element_head(label, 1, Location::IntegrationPoint, 1, 2));
                for (variable, key, values) in [("S", 11, &values[3..]), ("E", 21, &values[..3])] {
                    if request.variables.iter().any(|wanted| wanted == variable) {
                        self.stream.push(&Record::new(key).reals(values));
                    }
                }
            }
        }
    }

    fn contact(&mut self, increment: &Increment<'_>, request: &ContactRequest) {
        let (prepared, mesh) = (increment.prepared, &increment.prepared.model().mesh);
        let records = [(1511, &COMPONENTS[..3]), (1512, &COMPONENTS[3..6]), (1521, &COMPONENTS[6..])];
        for (i, pair) in prepared.model().pairs.iter().enumerate().filter(|(_, pair)| request.selects(pair)) {
            let Some(surfaces) = pair.surfaces() else { continue };
            let name = |surface: SurfaceId| self.labels.word(&mesh.surfaces[surface.index()].name);
            let set = request.nodes.map(|set| self.labels.word(&mesh.node_sets[set.index()].name));
            let head = Record::new(1503).whole(0).word(&name(surfaces.secondary)).word(&name(surfaces.primary));
            self.stream.push(&head.word(&set.unwrap_or_default()));
            let wanted: Vec<_> =
                records.into_iter().enumerate().filter(|(_, (_, names))| request.asks_for(names)).collect();
            if !wanted.is_empty() {
                for (point, result) in points_of(prepared, increment.contact, request, i) {
                    let values = values(result);
                    let label = mesh.node_labels[point.node.index()];
                    self.stream.push(&Record::new(1504).wholes([label, 3]));
                    for &(group, (key, _)) in &wanted {
                        self.stream.push(&Record::new(key).reals(&values[3 * group..3 * group + 3]));
                    }
                }
            }
            let Some(resultants) = increment.resultants.get(i) else { continue };
            for (family, key) in TOTALS.into_iter().filter(|(family, _)| request.asks_for(&[family])) {
                let Some(vector) = resultants.family(family) else { continue };
                let size = family.starts_with('C').then(|| magnitude(vector));
                let values: Vec<f64> = size.into_iter().chain(vector).collect();
                self.stream.push(&Record::new(key).reals(&values));
            }
            if request.asks_for(&["CAREA"]) {
                self.stream.push(&Record::new(AREA).reals(&[resultants.area]));
            }
        }
    }
}
