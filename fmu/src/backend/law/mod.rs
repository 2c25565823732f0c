//! A pressure-overclosure law inside an FMU: outputs follow inputs at once.

mod variables;

pub use variables::{LAW_KIND, TABLE_POINTS_MAX, variables};

use overclosure::law::{
    CurveParameters, Damping, DampingSpec, LawParameters, LawProcedure, LawSpec, PressureLaw, ResolvedLaw, Separation,
};
use variables::{Integers, Reals, TABLE_TEXT};

use super::Backend;
use crate::status::Fault;
use crate::variables::{Causality, Values, VariableTable};

/// A law with its parameters.
pub struct LawBackend {
    table: VariableTable,
    /// The law of the last parameters that fitted together, and its damping, if any.
    law: Option<(ResolvedLaw, Option<Damping>)>,
    /// A parameter was set since the law was made.
    outdated: bool,
}

impl Default for LawBackend {
    fn default() -> Self {
        Self { table: VariableTable::new(variables()), law: None, outdated: true }
    }
}

impl Backend for LawBackend {
    fn table(&self) -> &VariableTable {
        &self.table
    }

    fn feeds_through(&self) -> bool {
        true
    }

    fn note_set(&mut self, position: usize) {
        let parameter = |variable: &crate::variables::Variable| variable.causality == Causality::TunableParameter;
        self.outdated |= self.table.variables().get(position).is_some_and(parameter);
    }

    fn begin(&mut self, _: &mut Values) -> Result<(), Fault> {
        Ok(())
    }

    fn refresh(&mut self, values: &mut Values) -> Result<(), Fault> {
        if self.outdated {
            let law = law_of(values).map_err(Fault::Refused)?;
            self.law = Some((law, damping_of(values).map_err(Fault::Refused)?));
        }
        let (law, damping) = self.law.as_ref().expect("a law was made just now, or before it was outdated");
        evaluate(law, *damping, values);
        self.outdated = false;
        Ok(())
    }

    fn step(&mut self, _: f64, values: &mut Values) -> Result<(), Fault> {
        self.refresh(values)
    }

    fn reset(&mut self) {
        self.law = None;
        self.outdated = true;
    }

    fn save(&self) -> Vec<u8> {
        Vec::new()
    }

    fn restore(&mut self, bytes: &[u8], _: &Values) -> Result<(), String> {
        if !bytes.is_empty() {
            return Err("saved state is not one of a law".into());
        }
        // Outputs were saved with the values; the law follows from them when it is needed again.
        self.outdated = true;
        Ok(())
    }
}

/// The law that the parameters describe, or every reason why they describe none.
fn law_of(values: &Values) -> Result<ResolvedLaw, String> {
    let area = values.reals[Reals::AREA];
    if area <= 0.0 {
        return Err(format!("area must be positive, not {area}"));
    }
    let clearance = values.reals[Reals::CLEARANCE_AT_ZERO_PRESSURE];
    let pressure = values.reals[Reals::PRESSURE_AT_ZERO_CLEARANCE];
    let twin = values.integers[Integers::KIND_INTEGER];
    let kind = if twin == 0 { values.integers[Integers::KIND] } else { twin };
    let stiffness = values.reals[Reals::LAW_STIFFNESS];
    let gap = values.reals[Reals::PENALTY_CLEARANCE];
    let separation =
        if values.integers[Integers::SEPARATION] == 0 { Separation::Allowed } else { Separation::Prevented };
    // Where the manual's products differ, the one that has the combination is meant.
    let explicit_if = |needed: bool| if needed { LawProcedure::Explicit } else { LawProcedure::Standard };
    let mut procedure = explicit_if(separation == Separation::Prevented && kind <= 3);
    let parameters = match kind {
        1 => LawParameters::Linear { stiffness }.into(),
        2 => tabular(values)?,
        3 => {
            let limit = values.reals[Reals::STIFFNESS_MAX];
            let stiffness_max = (limit != 0.0).then_some(limit);
            procedure = explicit_if(stiffness_max.is_some());
            LawParameters::Exponential {
                clearance_at_zero_pressure: clearance,
                pressure_at_zero_clearance: pressure,
                stiffness_max,
            }
            .into()
        }
        4 => LawParameters::CalculixExponential { clearance, pressure }.into(),
        5 => CurveParameters::Penalty { stiffness, clearance: gap },
        6 => CurveParameters::NonlinearPenalty {
            stiffness_initial: values.reals[Reals::PENALTY_STIFFNESS_INITIAL],
            stiffness_final: values.reals[Reals::PENALTY_STIFFNESS_FINAL],
            lower: values.reals[Reals::PENALTY_LOWER],
            upper: values.reals[Reals::PENALTY_UPPER],
            clearance: gap,
        },
        7 => {
            let multiplier = values.reals[Reals::PENALTY_MULTIPLIER];
            CurveParameters::AugmentedLagrange { stiffness, multiplier, clearance: gap }
        }
        other => return Err(format!("law.kind: there is no law number {other}")),
    };
    LawSpec { parameters, separation, procedure }
        .resolve()
        .map_err(|errors| format!("{} law: {errors}", LAW_KIND.items[kind as usize - 1].0))
}

/// The damping that the parameters describe; none when its coefficient is zero.
fn damping_of(values: &Values) -> Result<Option<Damping>, String> {
    let coefficient = values.reals[Reals::DAMPING_COEFFICIENT_MAX];
    if coefficient == 0.0 {
        return Ok(None);
    }
    let (clearance, fraction) = (values.reals[Reals::DAMPING_CLEARANCE], values.reals[Reals::DAMPING_FRACTION]);
    let spec = DampingSpec { coefficient, clearance, fraction };
    spec.resolve().map(Some).map_err(|errors| format!("damping: {errors}"))
}

fn tabular(values: &Values) -> Result<CurveParameters, String> {
    let text = values.strings[TABLE_TEXT].trim();
    if !text.is_empty() {
        return LawSpec::parse("tabular", &[("table", text)])
            .map(|spec| spec.parameters)
            .map_err(|errors| format!("table.text: {errors}"));
    }
    let points = values.integers[Integers::TABLE_N] as usize;
    let column = |from: usize| values.reals[from..from + points].iter().copied();
    let points = column(Reals::TABLE_PRESSURE).zip(column(Reals::TABLE_OVERCLOSURE)).collect();
    Ok(LawParameters::Tabular { points }.into())
}

fn evaluate(law: &ResolvedLaw, damping: Option<Damping>, values: &mut Values) {
    let reals = &mut values.reals;
    let (area, speed) = (reals[Reals::AREA], reals[Reals::CLOSING_VELOCITY]);
    let overclosure = reals[Reals::OVERCLOSURE];
    let point = law.evaluate(overclosure);
    let (coefficient, slope) = damping.map_or((0.0, 0.0), |damping| damping.at(overclosure));
    // Where nothing is damped, zero times the speed has no sign.
    let viscous = if coefficient == 0.0 { 0.0 } else { finite(coefficient * speed) };
    let softening = if slope == 0.0 { 0.0 } else { finite(slope * speed) };
    let force = finite(area * (point.pressure + viscous));
    reals[Reals::PRESSURE] = point.pressure;
    reals[Reals::FORCE] = force;
    reals[Reals::STIFFNESS] = point.stiffness;
    reals[Reals::FORCE_STIFFNESS] = finite(area * (point.stiffness + softening));
    reals[Reals::ENERGY] = point.energy;
    reals[Reals::STORED_ENERGY] = finite(area * point.energy);
    reals[Reals::POWER] = finite(force * speed);
    reals[Reals::VISCOUS_PRESSURE] = viscous;
    reals[Reals::DAMPING_COEFFICIENT] = coefficient;
    reals[Reals::FORCE_DAMPING] = finite(area * coefficient);
    reals[Reals::DISSIPATED_POWER] = finite(finite(area * viscous) * speed);
    values.integers[Integers::STATUS] = match (point.pressure != 0.0, viscous != 0.0) {
        (true, _) => 1,
        (false, true) => 2,
        (false, false) => 0,
    };
}

/// Saturated like the laws themselves: no output is ever infinite.
fn finite(value: f64) -> f64 {
    value.clamp(-f64::MAX, f64::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outputs(change: impl FnOnce(&mut Values)) -> Result<Values, Fault> {
        let mut backend = LawBackend::default();
        let mut values = backend.table().start_values();
        change(&mut values);
        backend.refresh(&mut values).map(|()| values)
    }

    #[test]
    fn force_and_power_follow_from_the_pressure() {
        let values = outputs(|values| {
            values.reals[Reals::AREA] = 2.0;
            values.reals[Reals::LAW_STIFFNESS] = 250.0;
            values.reals[Reals::OVERCLOSURE] = 0.06;
            values.reals[Reals::CLOSING_VELOCITY] = -0.5;
        })
        .expect("a law");
        assert_eq!(values.reals[Reals::PRESSURE], 15.0);
        assert_eq!(values.reals[Reals::FORCE], 30.0);
        assert_eq!(values.reals[Reals::FORCE_STIFFNESS], 500.0);
        assert_eq!(values.reals[Reals::POWER], -15.0);
        assert_eq!(values.integers[Integers::STATUS], 1);
    }

    #[test]
    fn text_and_arrays_make_the_same_table() {
        let arrays = outputs(|values| {
            values.integers[Integers::KIND_INTEGER] = 2;
            values.integers[Integers::TABLE_N] = 3;
            for (row, (p, h)) in [(0.0, 0.0), (2.0, 0.01), (10.0, 0.02)].into_iter().enumerate() {
                values.reals[Reals::TABLE_PRESSURE + row] = p;
                values.reals[Reals::TABLE_OVERCLOSURE + row] = h;
            }
            values.reals[Reals::OVERCLOSURE] = 0.015;
        })
        .expect("a law");
        let text = outputs(|values| {
            values.integers[Integers::KIND] = 2;
            values.strings[TABLE_TEXT] = "0:0,2:0.01,10:0.02".into();
            values.reals[Reals::OVERCLOSURE] = 0.015;
        })
        .expect("a law");
        assert_eq!(arrays.reals[Reals::PRESSURE], 6.0);
        assert_eq!(arrays.reals[Reals::PRESSURE], text.reals[Reals::PRESSURE]);
        assert_eq!(arrays.reals[Reals::ENERGY], text.reals[Reals::ENERGY]);
    }

    #[test]
    fn parameters_that_do_not_fit_are_named() {
        let error = outputs(|values| values.reals[Reals::LAW_STIFFNESS] = -1.0).expect_err("refused");
        assert!(error.to_string().contains("stiffness"), "{error}");
        let error = outputs(|values| values.reals[Reals::AREA] = 0.0).expect_err("refused");
        assert!(error.to_string().contains("area"), "{error}");
        let error = outputs(|values| {
            values.integers[Integers::KIND] = 2;
            values.integers[Integers::TABLE_N] = 3;
        })
        .expect_err("refused");
        assert!(error.to_string().contains("table point 3"), "{error}");
    }

    #[test]
    fn damping_adds_to_the_force_and_acts_before_contact() {
        let at = |overclosure: f64, speed: f64| {
            outputs(|values| {
                values.reals[Reals::AREA] = 2.0;
                values.reals[Reals::LAW_STIFFNESS] = 250.0;
                values.reals[Reals::DAMPING_COEFFICIENT_MAX] = 8.0;
                values.reals[Reals::DAMPING_CLEARANCE] = 0.5;
                values.reals[Reals::DAMPING_FRACTION] = 0.5;
                values.reals[Reals::OVERCLOSURE] = overclosure;
                values.reals[Reals::CLOSING_VELOCITY] = speed;
            })
            .expect("a law")
        };
        let values = at(0.06, 0.5);
        assert_eq!(values.reals[Reals::PRESSURE], 15.0);
        assert_eq!(values.reals[Reals::VISCOUS_PRESSURE], 4.0);
        assert_eq!(values.reals[Reals::FORCE], 38.0);
        assert_eq!(values.reals[Reals::DISSIPATED_POWER], 4.0);
        assert_eq!(values.reals[Reals::POWER], 19.0);
        assert_eq!(values.integers[Integers::STATUS], 1);
        // Half way down the ramp, opening: suction.
        let values = at(-0.375, -0.5);
        assert_eq!(values.reals[Reals::FORCE], -4.0);
        assert_eq!(values.reals[Reals::FORCE_STIFFNESS], 2.0 * 32.0 * -0.5);
        assert_eq!(values.reals[Reals::FORCE_DAMPING], 8.0);
        assert_eq!(values.integers[Integers::STATUS], 2);
        assert_eq!(at(-0.375, 0.0).integers[Integers::STATUS], 0);
    }

    #[test]
    fn tension_needs_a_law_that_has_one() {
        let prevented = |kind: i32| {
            outputs(|values| {
                values.integers[Integers::KIND] = kind;
                values.integers[Integers::SEPARATION] = 1;
                values.reals[Reals::OVERCLOSURE] = -1e-5;
            })
        };
        assert_eq!(prevented(1).expect("explicit").reals[Reals::PRESSURE], -1e4);
        assert_eq!(prevented(5).expect("a penalty").reals[Reals::PRESSURE], -1e4);
        for kind in [3, 4] {
            let error = prevented(kind).expect_err("no tension").to_string();
            assert!(error.contains("exponential"), "{error}");
        }
    }

    #[test]
    fn outputs_stay_finite_at_the_end_of_the_range() {
        let values = outputs(|values| {
            values.reals[Reals::AREA] = 1e10;
            values.reals[Reals::OVERCLOSURE] = f64::MAX;
            values.reals[Reals::CLOSING_VELOCITY] = -1e10;
            values.reals[Reals::DAMPING_COEFFICIENT_MAX] = 1e300;
        })
        .expect("a law");
        assert!(values.reals.iter().all(|value| value.is_finite()));
    }
}
