//! `JOB.pvd` and `JOB_00001.vtu`, …: fields for ParaView, one file per written frame.

use std::fs::{self, File};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::NodalFields;
use super::file::OutputError;
use super::vtu::{Array, Grid};
use crate::model::{ElementShape, Mesh, Model};
use crate::simulation::{ContactPointResult, PreparedModel};

/// VTK's cell type of a shape, and VTK's order of its nodes where that is not the order of the manual: the first triangle of
/// a wedge faces outward.
fn cell(shape: ElementShape) -> (u8, Option<&'static [usize]>) {
    match shape {
        ElementShape::Tetrahedron4 => (10, None),
        ElementShape::Tetrahedron10 => (24, None),
        ElementShape::Wedge6 => (13, Some(&[0, 2, 1, 3, 5, 4])),
        ElementShape::Wedge15 => (26, Some(&[0, 2, 1, 3, 5, 4, 8, 7, 6, 11, 10, 9, 12, 14, 13])),
        ElementShape::Hexahedron8 => (12, None),
        ElementShape::Hexahedron20 => (25, None),
        ElementShape::Line2 => (3, None),
        ElementShape::Point1 => (1, None),
        ElementShape::Triangle3 => (5, None),
        ElementShape::Quadrilateral4 => (9, None),
    }
}

/// `CSTATUS` of a node that is no contact point.
const NO_CONTACT_POINT: i8 = -1;

const PVD_HEAD: &str = "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n<Collection>\n";
const PVD_TAIL: &str = "</Collection>\n</VTKFile>\n";

/// Writes frames and keeps their list valid at any time.
pub(super) struct Frames {
    directory: PathBuf,
    job: String,
    list_path: PathBuf,
    list: File,
    /// Where the tail of the list begins.
    list_end: u64,
    count: u32,
    mesh: MeshArrays,
}

/// What does not change from frame to frame.
struct MeshArrays {
    coordinates: Array,
    topology: [Array; 3],
    node_labels: Array,
    element_labels: Array,
    materials: Array,
}

impl Frames {
    pub(super) fn create(directory: &Path, job: &str, model: &Model) -> Result<Self, OutputError> {
        remove_frames(directory, job)?;
        let list_path = directory.join(format!("{job}.pvd"));
        let mut list = File::create(&list_path).map_err(OutputError::at(&list_path))?;
        list.write_all(PVD_HEAD.as_bytes())
            .and_then(|()| list.write_all(PVD_TAIL.as_bytes()))
            .map_err(OutputError::at(&list_path))?;
        Ok(Self {
            directory: directory.to_owned(),
            job: job.to_owned(),
            list_path,
            list,
            list_end: PVD_HEAD.len() as u64,
            count: 0,
            mesh: MeshArrays::new(model),
        })
    }

    /// Writes a frame and enters it into the list.
    pub(super) fn write(
        &mut self,
        prepared: &PreparedModel,
        time: f64,
        fields: &NodalFields,
        contact: &[ContactPointResult],
    ) -> Result<(), OutputError> {
        self.count += 1;
        let name = format!("{}_{:05}.vtu", self.job, self.count);
        let path = self.directory.join(&name);
        self.write_frame(&path, prepared, fields, contact).map_err(OutputError::at(&path))?;
        self.enter(&name, time).map_err(OutputError::at(&self.list_path))
    }

    fn write_frame(
        &self,
        path: &Path,
        prepared: &PreparedModel,
        fields: &NodalFields,
        contact: &[ContactPointResult],
    ) -> io::Result<()> {
        let mesh = &prepared.model().mesh;
        let surface = SurfaceFields::new(prepared, contact);
        let count = mesh.node_count();
        let displacement = &fields.solution.displacement;
        let reaction = &fields.solution.reaction;
        let arrays = [
            Array::real("U", &["U1", "U2", "U3"], displacement.iter().take(count).flatten().copied()),
            Array::real("RF", &["RF1", "RF2", "RF3"], reaction.iter().take(count).flatten().copied()),
            // The order of symmetric tensors in VTK.
            Array::real(
                "S",
                &["S11", "S22", "S33", "S12", "S23", "S13"],
                fields.stress.iter().take(count).flat_map(|s| [s[0], s[1], s[2], s[3], s[5], s[4]]),
            ),
            Array::real("S_MISES", &[], fields.stress.iter().take(count).map(mises)),
            Array::real("CPRESS", &[], surface.pressure.into_iter()),
            Array::real("COPEN", &[], surface.clearance.into_iter()),
            Array::real("CDPRESS", &[], surface.viscous.into_iter()),
            Array::real("CSHEAR", &["CSHEAR1", "CSHEAR2"], surface.shear.into_iter().flatten()),
            Array::real("CSLIP", &["CSLIP1", "CSLIP2"], surface.slip.into_iter().flatten()),
            Array::small("CSTATUS", surface.status.into_iter()),
        ];
        // A static frame has neither.
        let of_motion = [
            ("V", &["V1", "V2", "V3"][..], &fields.solution.velocity),
            ("A", &["A1", "A2", "A3"], &fields.solution.acceleration),
        ];
        let of_motion: Vec<Array> = (of_motion.into_iter())
            .filter(|(_, _, values)| !values.is_empty())
            .map(|(name, components, values)| {
                Array::real(name, components, values.iter().take(count).flatten().copied())
            })
            .collect();
        let mut point_data: Vec<&Array> = arrays.iter().chain(&of_motion).collect();
        point_data.push(&self.mesh.node_labels);
        let [connectivity, offsets, types] = &self.mesh.topology;
        Grid {
            points: count,
            cells: mesh.elements.len(),
            point_data,
            cell_data: vec![&self.mesh.element_labels, &self.mesh.materials],
            coordinates: &self.mesh.coordinates,
            topology: [connectivity, offsets, types],
        }
        .write(path)
    }

    /// Overwrites the tail of the list with the entry and a new tail.
    fn enter(&mut self, name: &str, time: f64) -> io::Result<()> {
        let file = name.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
        let entry = format!("<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{file}\"/>\n");
        self.list.seek(SeekFrom::Start(self.list_end))?;
        self.list.write_all(format!("{entry}{PVD_TAIL}").as_bytes())?;
        self.list_end += entry.len() as u64;
        self.list.flush()
    }
}

impl MeshArrays {
    fn new(model: &Model) -> Self {
        let mesh = &model.mesh;
        Self {
            coordinates: Array::real(
                "Points",
                &["", "", ""],
                mesh.nodes.iter().take(mesh.node_count()).flatten().copied(),
            ),
            topology: [
                Array::whole("connectivity", connectivity(mesh).into_iter()),
                Array::whole("offsets", offsets(mesh).into_iter()),
                Array::byte("types", types(mesh).into_iter()),
            ],
            node_labels: Array::whole("node", mesh.node_labels.iter().take(mesh.node_count()).copied()),
            element_labels: Array::whole("element", mesh.element_labels.iter().copied()),
            materials: Array::whole("material", mesh.element_materials.iter().map(|m| m.0)),
        }
    }
}

/// Nodes of all cells in VTK's order.
fn connectivity(mesh: &Mesh) -> Vec<u32> {
    let mut out = Vec::with_capacity(mesh.elements.node_references());
    for (kind, nodes) in mesh.elements.iter() {
        match cell(kind.shape()).1 {
            None => out.extend(nodes.iter().map(|n| n.0)),
            Some(order) => out.extend(order.iter().map(|&a| nodes[a].0)),
        }
    }
    out
}

/// End of each cell in the connectivity.
fn offsets(mesh: &Mesh) -> Vec<u32> {
    let mut end = 0;
    let ends = mesh.elements.iter().map(|(_, nodes)| {
        end += nodes.len() as u32;
        end
    });
    ends.collect()
}

fn types(mesh: &Mesh) -> Vec<u8> {
    mesh.elements.iter().map(|(kind, _)| cell(kind.shape()).0).collect()
}

/// Contact results as nodal fields: no pressure and an undefined clearance (NaN) away from the contact points. A node that is a
/// contact point of several pairs shows the one with the smallest clearance.
struct SurfaceFields {
    pressure: Vec<f64>,
    clearance: Vec<f64>,
    viscous: Vec<f64>,
    shear: Vec<[f64; 2]>,
    slip: Vec<[f64; 2]>,
    status: Vec<i8>,
}

impl SurfaceFields {
    fn new(prepared: &PreparedModel, contact: &[ContactPointResult]) -> Self {
        let nodes = prepared.model().mesh.node_count();
        let mut fields = Self {
            pressure: vec![0.0; nodes],
            clearance: vec![f64::NAN; nodes],
            viscous: vec![0.0; nodes],
            shear: vec![[0.0; 2]; nodes],
            slip: vec![[0.0; 2]; nodes],
            status: vec![NO_CONTACT_POINT; nodes],
        };
        for (point, result) in prepared.contact_points().iter().zip(contact) {
            let i = point.node.index();
            if fields.status[i] == NO_CONTACT_POINT || result.clearance < fields.clearance[i] {
                fields.pressure[i] = result.pressure;
                fields.clearance[i] = result.clearance;
                fields.viscous[i] = result.viscous;
                fields.shear[i] = result.shear;
                fields.slip[i] = result.slip;
                fields.status[i] = result.status.number();
            }
        }
        fields
    }
}

/// Equivalent stress of (11, 22, 33, 12, 13, 23).
fn mises(s: &[f64; 6]) -> f64 {
    let normal = (s[0] - s[1]).powi(2) + (s[1] - s[2]).powi(2) + (s[2] - s[0]).powi(2);
    let shear = s[3].powi(2) + s[4].powi(2) + s[5].powi(2);
    (0.5 * normal + 3.0 * shear).sqrt()
}

/// Frames of an earlier run that had more of them would be taken for ours.
fn remove_frames(directory: &Path, job: &str) -> Result<(), OutputError> {
    let prefix = format!("{job}_");
    for entry in fs::read_dir(directory).map_err(OutputError::at(directory))? {
        let path = entry.map_err(OutputError::at(directory))?.path();
        let number = path
            .file_name()
            .and_then(|name| name.to_str())
            .and_then(|name| name.strip_prefix(&prefix))
            .and_then(|rest| rest.strip_suffix(".vtu"));
        if number.is_some_and(|n| n.len() >= 5 && n.bytes().all(|b| b.is_ascii_digit())) {
            fs::remove_file(&path).map_err(OutputError::at(&path))?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equivalent_stress_of_simple_states() {
        assert_eq!(mises(&[3.0, 0.0, 0.0, 0.0, 0.0, 0.0]), 3.0);
        assert_eq!(mises(&[7.0, 7.0, 7.0, 0.0, 0.0, 0.0]), 0.0);
        assert!((mises(&[0.0, 0.0, 0.0, 0.0, 2.0, 0.0]) - 2.0 * 3f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn bars_springs_and_masses_are_lines_and_vertices() {
        use crate::model::{ElementKind, NodeId};
        let mut mesh = Mesh::default();
        let list = |count: u32| (0..count).map(NodeId).collect::<Vec<_>>();
        let kinds = [
            (ElementKind::C3D4, 10),
            (ElementKind::T3D2, 3),
            (ElementKind::SpringA, 3),
            (ElementKind::Spring1, 1),
            (ElementKind::Spring2, 3),
            (ElementKind::Mass, 1),
        ];
        for (kind, _) in kinds {
            mesh.elements.push(kind, &list(kind.node_count() as u32));
        }
        // VTK_TETRA, VTK_LINE, VTK_VERTEX.
        assert_eq!(types(&mesh), kinds.map(|(_, number)| number));
        assert_eq!(offsets(&mesh), [4, 6, 8, 9, 11, 12]);
        assert_eq!(connectivity(&mesh), [0, 1, 2, 3, 0, 1, 0, 1, 0, 0, 1, 0]);
    }

    #[test]
    fn the_list_is_complete_after_every_frame_and_old_frames_are_gone() {
        let directory = tempfile::tempdir().unwrap();
        let stale = directory.path().join("job_00042.vtu");
        let foreign = directory.path().join("job_mine.vtu");
        fs::write(&stale, "old").unwrap();
        fs::write(&foreign, "mine").unwrap();
        let mut frames = Frames::create(directory.path(), "job", &Model::default()).unwrap();
        assert!(!stale.exists() && foreign.exists());
        for (name, time) in [("job_00001.vtu", 0.5), ("job_00002.vtu", 1.0)] {
            frames.enter(name, time).unwrap();
            let text = fs::read_to_string(directory.path().join("job.pvd")).unwrap();
            assert!(text.starts_with(PVD_HEAD) && text.ends_with(PVD_TAIL), "{text}");
            assert!(text.contains(name));
            assert_eq!(text.matches("</Collection>").count(), 1);
        }
    }
}
