//! Preparation: everything that can be computed before the first increment.

use std::path::{Path, PathBuf};

use crate::cache;
use crate::condensation::{Setting, Statics};
use crate::contact::points::ContactPoint;
use crate::diagnostic::{Diagnostic, Place};
use crate::element::{Elasticity, connector};
use crate::examination::{self, Examined};
use crate::explicit::{self, ExplicitModel};
use crate::fingerprint::fingerprint;
use crate::implicit::ImplicitModel;
use crate::model::{Connector, ElementId, Equation, Model};
use crate::nodal::Nodal;
use crate::outputs::{Outputs, Source};
use crate::port::PortList;
use crate::port_config::PortConfig;
use crate::procedure::loading::Loading;
use crate::procedure::rows::RowPlan;
use crate::simulation::{ContactPointInfo, Phase, PrepareOptions};
use crate::solve::assembly::{coordinates, elasticities};
use crate::solve::budget::Budget;
use crate::solve::columns::Column;
use crate::solve::constraints::Constraints;
use crate::solve::context::{Blend, Context};
use crate::solve::floating::Floating;
use crate::solve::motions::Motions;
use crate::solve::numbering::Bodies;
use crate::solve::parts::Sample;

/// Everything that can be computed before the first increment. Immutable; shared by sessions and instances.
pub struct PreparedModel {
    pub(crate) model: Model,
    pub(crate) ports: PortList,
    pub(crate) points: Vec<ContactPoint>,
    /// Contact points followed by the tangential rows, as bodies see them.
    pub(crate) row_points: Vec<ContactPoint>,
    /// What the rows are made of.
    pub(crate) rows: RowPlan,
    pub(crate) infos: Vec<ContactPointInfo>,
    pub(crate) warnings: Vec<Diagnostic>,
    pub(crate) loading: Loading,
    pub(crate) constraints: Constraints,
    pub(crate) numbering: Bodies,
    pub(crate) motions: Vec<Motions>,
    pub(crate) floating: Floating,
    pub(crate) elasticities: Vec<Elasticity>,
    /// What static steps need; none without one.
    pub(crate) statics: Option<Statics>,
    /// Elements with a prescribed direction: they carry the reactions.
    pub(crate) support_elements: Vec<u32>,
    /// What implicit dynamic steps need; none without one.
    pub(crate) implicit: Option<ImplicitModel>,
    /// What explicit steps need; none without one.
    pub(crate) explicit: Option<ExplicitModel>,
    /// What dynamic steps need; none without one.
    pub(crate) nodal: Option<Nodal>,
    /// Every column: those that carry loads, then those that only measure.
    pub(crate) columns: Vec<Column>,
    /// Columns that carry loads; the rest only measure.
    pub(crate) real_columns: usize,
    /// Selected output ports' sources.
    pub(crate) sources: Vec<Source>,
    pub(crate) outputs: Outputs,
    /// Total force of unit coefficients, per real column and direction: the audit.
    pub(crate) load_totals: Vec<[f64; 3]>,
    /// Whether no equation and no spring resists a translation of everything in a direction: then forces balance in it.
    pub(crate) translates: [bool; 3],
    pub(crate) fingerprint: u64,
    /// Size of the model: what rounding of coordinates is judged against \[length\].
    pub(crate) extent: f64,
}

impl PreparedModel {
    /// Prepares a validated model. Errors are findings about the deck (a body that nothing holds, an inverted element).
    pub fn prepare(
        model: Model,
        options: &PrepareOptions,
        announce: &mut dyn FnMut(Phase),
    ) -> Result<Self, Vec<Diagnostic>> {
        announce(Phase::Search);
        let Examined { constraints, points, row_points, rows, bodies, motions, floating, loading, mut warnings } =
            examination::examine(&model)?;
        let mut columns = loading.columns.clone();
        let real_columns = columns.len();
        let outputs = Outputs::new(&model, &constraints, &mut columns);
        constraints.extend(&mut columns[real_columns..]);
        let first_loose = columns.len();
        columns.extend(floating.loose_columns(&constraints, &bodies, &motions));
        let elasticities = elasticities(&model);
        let budget = Budget::new(options.memory_limit);
        let context = Context {
            model: &model,
            budget: &budget,
            elasticities: &elasticities,
            constraints: &constraints,
            local: &bodies.local,
            points: &row_points,
            columns: &columns,
            blend: Blend::STIFFNESS,
        };
        let fingerprint = fingerprint(&model);
        let setting = Setting {
            bodies: &bodies,
            motions: &motions,
            floating: &floating,
            rows: rows.count(),
            real_columns,
            first_loose,
        };
        let statics = match model.has_statics() {
            false => None,
            true => Some(Statics::prepare(&context, &setting, options, fingerprint, announce)?),
        };
        let implicit = ImplicitModel::new(&context, &bodies, options.path, options.memory_limit);
        let nodal =
            model.has_dynamics().then(|| Nodal::new(&constraints, &row_points, points.len(), model.mesh.nodes.len()));
        let explicit = match &nodal {
            Some(nodal) if model.is_explicit() => {
                let setting = explicit::Setting {
                    model: &model,
                    elasticities: &elasticities,
                    constraints: &constraints,
                    columns: &columns[..real_columns],
                    nodal,
                    points: &points,
                    row_points: &row_points,
                    tangential: rows.first_tangential(),
                };
                announce(Phase::Assemble);
                let mut explicit = ExplicitModel::new(&setting, &budget)?;
                warnings.append(&mut explicit.warnings);
                Some(explicit)
            }
            _ => None,
        };
        let all = PortList { inputs: loading.inputs.clone(), outputs: outputs.ports.clone() };
        let (ports, sources) = match &options.ports_toml {
            None => (all, outputs.sources.clone()),
            Some(text) => PortConfig::parse(text).and_then(|c| c.apply(all, &outputs.sources)).map_err(|messages| {
                let as_error = |m: String| Diagnostic::error(Place::nowhere(), "ports.toml", m, "");
                messages.into_iter().map(as_error).collect::<Vec<_>>()
            })?,
        };
        let support_elements = (0..model.mesh.elements.len() as u32)
            .filter(|&e| model.mesh.elements.nodes(e as usize).iter().any(|&n| constraints.touches(n)))
            .collect();
        let infos = points
            .iter()
            .map(|p| ContactPointInfo {
                pair: p.pair,
                node: p.node,
                area: p.area,
                normal: p.normal,
                clearance: p.clearance,
            })
            .collect();
        let extent = model.mesh.nodes.iter().flatten().fold(0.0f64, |m, x| x.abs().max(m));
        let load_totals = loading.columns.iter().map(total_force).collect();
        let translates = std::array::from_fn(|d| translates(&model, d));
        Ok(Self {
            model,
            ports,
            points,
            row_points,
            rows,
            infos,
            warnings,
            loading,
            constraints,
            numbering: bodies,
            motions,
            floating,
            elasticities,
            statics,
            implicit,
            explicit,
            nodal,
            support_elements,
            columns,
            real_columns,
            sources,
            outputs,
            load_totals,
            translates,
            fingerprint,
            extent,
        })
    }

    /// What [`Self::prepare`] would find wrong with a model or warn of before it factors anything: bodies that nothing
    /// holds, secondary nodes without a partner, lines that contradict each other. Cheap.
    pub fn examine(model: &Model) -> Vec<Diagnostic> {
        examination::examine(model).map_or_else(|errors| errors, |examined| examined.warnings)
    }

    /// What moves most in a combination of the free motions, and how, in words.
    pub(crate) fn describe_motion(&self, combination: &[f64]) -> (String, String) {
        let (sample, motion) = self.floating.describe(&self.motions, combination);
        let name = match sample {
            Sample::Node(node) => format!("node {}", self.model.mesh.node_labels[node.index()]),
            Sample::Element(e) => {
                let body = self.numbering.of_node[self.model.mesh.elements.nodes(e as usize)[0].index()] as usize;
                examination::body_name(&self.model, &self.numbering.nodes[body], &self.numbering.elements[body])
            }
        };
        (name, motion)
    }

    /// The model as the deck describes it.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// Findings of the preparation that do not stop it (points without a partner, …).
    pub fn warnings(&self) -> &[Diagnostic] {
        &self.warnings
    }

    /// Inputs and outputs.
    pub fn ports(&self) -> &PortList {
        &self.ports
    }

    /// Contact points, pairs one after another, in the order of every per-point result.
    pub fn contact_points(&self) -> &[ContactPointInfo] {
        &self.infos
    }

    /// Names of the node sets whose reaction totals stand in each history row.
    pub fn total_set_names(&self) -> Vec<&str> {
        self.outputs.sets.iter().map(|s| self.model.mesh.node_sets[s.index()].name.as_str()).collect()
    }

    /// Identifies the model among others: equal decks have equal fingerprints.
    pub fn fingerprint(&self) -> u64 {
        self.fingerprint
    }

    /// What bodies need to know of the model to recover fields.
    pub(crate) fn context<'a>(&'a self, budget: &'a Budget) -> Context<'a> {
        Context {
            model: &self.model,
            elasticities: &self.elasticities,
            constraints: &self.constraints,
            local: &self.numbering.local,
            budget,
            points: &self.row_points,
            columns: &self.loading.columns,
            blend: Blend::STIFFNESS,
        }
    }

    /// Where a cache directory keeps this model.
    pub fn file_in(&self, directory: &Path) -> PathBuf {
        cache::file_in(directory, self.fingerprint)
    }

    /// Sparse factorisations that the preparation did.
    pub(crate) fn factorizations(&self) -> u32 {
        let factored = |statics: &Statics| statics.bodies.iter().filter(|b| b.was_factored()).count() as u32;
        self.statics.as_ref().map_or(0, factored)
    }

    /// What explicit steps need.
    pub(crate) fn explicit(&self) -> &ExplicitModel {
        self.explicit.as_ref().expect("only explicit steps ask, and a deck that has one prepares for them")
    }

    /// What implicit dynamic steps need.
    pub(crate) fn implicit(&self) -> &ImplicitModel {
        self.implicit.as_ref().expect("only implicit dynamic steps ask, and a deck that has one prepares for them")
    }

    /// A body in words.
    pub(crate) fn name_of_body(&self, body: usize) -> String {
        examination::body_name(&self.model, &self.numbering.nodes[body], &self.numbering.elements[body])
    }

    /// What dynamic steps need.
    pub(crate) fn nodal(&self) -> &Nodal {
        self.nodal.as_ref().expect("only dynamic steps ask, and a deck that has one prepares for them")
    }

    /// What static steps need.
    pub(crate) fn statics(&self) -> &Statics {
        self.statics.as_ref().expect("only static steps ask, and a deck that has one prepares for them")
    }
}

/// Whether equations and springs let everything move together in a direction.
fn translates(model: &Model, direction: usize) -> bool {
    let by_equation = |e: &Equation| {
        let along = e.terms.iter().filter(|t| usize::from(t.1) == direction);
        let (sum, scale) = along.fold((0.0, 0.0), |(s, a): (f64, f64), t| (s + t.2, a + t.2.abs()));
        sum.abs() <= 1e-12 * scale
    };
    let by_spring = |(&element, &section): (&ElementId, &Connector)| {
        let kind = model.mesh.elements.kind(element.index());
        let b = connector::elongation(kind, &coordinates(&model.mesh, element.0), section);
        (b[0][direction] + b[1][direction]).abs() <= 1e-12
    };
    model.equations.iter().all(by_equation) && model.mesh.connectors.iter().all(by_spring)
}

/// Total force of a column of coefficient 1.
fn total_force(column: &Column) -> [f64; 3] {
    let mut total = [0.0; 3];
    if let Column::Force(entries) = column {
        for &(_, direction, value) in entries {
            total[direction as usize] += value;
        }
    }
    total
}
