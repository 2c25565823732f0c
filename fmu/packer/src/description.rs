//! `modelDescription.xml`.

use std::collections::BTreeSet;
use std::io;

use overclosure_fmu::log::CATEGORIES;
use overclosure_fmu::variables::{Causality, EnumerationType, Kind, Variability, Variable};
use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use crate::units;

/// What the description says besides its variables.
#[derive(Clone, Debug)]
pub struct Heading {
    /// Name of the model, for people.
    pub name: String,
    /// Name of the library file, without its ending.
    pub identifier: String,
    /// One sentence.
    pub description: String,
    /// How names are built.
    pub naming: Naming,
    /// End of the default experiment \[time\].
    pub stop: f64,
    /// Communication step of the default experiment \[time\].
    pub step: f64,
}

/// `variableNamingConvention`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Naming {
    /// Any text.
    Flat,
    /// Dots and indices mean something.
    Structured,
}

/// Who packed it.
pub const GENERATION_TOOL: &str = concat!("overclosure ", env!("CARGO_PKG_VERSION"));

type Out = Writer<Vec<u8>>;

/// Text of the description.
pub fn write(heading: &Heading, guid: &str, variables: &[Variable]) -> io::Result<String> {
    let mut out = Writer::new_with_indent(Vec::new(), b' ', 2);
    out.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    let naming = match heading.naming {
        Naming::Flat => "flat",
        Naming::Structured => "structured",
    };
    out.create_element("fmiModelDescription")
        .with_attributes([
            ("fmiVersion", "2.0"),
            ("modelName", &clean(&heading.name)),
            ("guid", guid),
            ("description", &clean(&heading.description)),
            ("version", env!("CARGO_PKG_VERSION")),
            ("license", "The library is MIT OR Apache-2.0; see documentation/licenses"),
            ("generationTool", GENERATION_TOOL),
            ("variableNamingConvention", naming),
        ])
        .write_inner_content(|out| {
            co_simulation(out, heading)?;
            unit_definitions(out, variables)?;
            type_definitions(out, variables)?;
            log_categories(out)?;
            out.create_element("DefaultExperiment")
                .with_attributes([
                    ("startTime", "0"),
                    ("stopTime", &number(heading.stop)),
                    ("stepSize", &number(heading.step)),
                ])
                .write_empty()?;
            out.create_element("ModelVariables").write_inner_content(|out| {
                variables.iter().enumerate().try_for_each(|(position, variable)| scalar(out, position, variable))
            })?;
            model_structure(out, variables)
        })?;
    let mut text = String::from_utf8(out.into_inner()).map_err(io::Error::other)?;
    text.push('\n');
    Ok(text)
}

fn co_simulation(out: &mut Out, heading: &Heading) -> io::Result<()> {
    out.create_element("CoSimulation")
        .with_attributes([
            ("modelIdentifier", heading.identifier.as_str()),
            ("needsExecutionTool", "false"),
            ("canHandleVariableCommunicationStepSize", "true"),
            ("canInterpolateInputs", "false"),
            ("maxOutputDerivativeOrder", "0"),
            ("canRunAsynchronuously", "false"),
            ("canBeInstantiatedOnlyOncePerProcess", "false"),
            ("canNotUseMemoryManagementFunctions", "true"),
            ("canGetAndSetFMUstate", "true"),
            ("canSerializeFMUstate", "true"),
            ("providesDirectionalDerivative", "false"),
        ])
        .write_empty()?;
    Ok(())
}

fn unit_definitions(out: &mut Out, variables: &[Variable]) -> io::Result<()> {
    let names: BTreeSet<&str> = variables
        .iter()
        .filter_map(|variable| match &variable.kind {
            Kind::Real { unit, .. } => unit.as_deref(),
            _ => None,
        })
        .collect();
    if names.is_empty() {
        return Ok(());
    }
    out.create_element("UnitDefinitions").write_inner_content(|out| {
        for name in names {
            let element = out.create_element("Unit").with_attribute(("name", clean(name).as_str()));
            match units::parse(name) {
                None => element.write_empty()?,
                Some(unit) => element.write_inner_content(|out| {
                    let exponents = [("kg", unit.kg), ("m", unit.m), ("s", unit.s)];
                    let mut base = out.create_element("BaseUnit");
                    for (symbol, exponent) in exponents.into_iter().filter(|&(_, exponent)| exponent != 0) {
                        base = base.with_attribute((symbol, exponent.to_string().as_str()));
                    }
                    if unit.factor != 1.0 {
                        base = base.with_attribute(("factor", number(unit.factor).as_str()));
                    }
                    base.write_empty().map(|_| ())
                })?,
            };
        }
        Ok(())
    })?;
    Ok(())
}

fn type_definitions(out: &mut Out, variables: &[Variable]) -> io::Result<()> {
    let mut types: Vec<&EnumerationType> = Vec::new();
    for variable in variables {
        if let Kind::Enumeration { definition, .. } = variable.kind
            && !types.iter().any(|known| known.name == definition.name)
        {
            types.push(definition);
        }
    }
    if types.is_empty() {
        return Ok(());
    }
    out.create_element("TypeDefinitions").write_inner_content(|out| {
        for definition in types {
            out.create_element("SimpleType")
                .with_attributes([("name", definition.name), ("description", definition.description)])
                .write_inner_content(|out| {
                    out.create_element("Enumeration").write_inner_content(|out| {
                        for ((name, description), value) in definition.items.iter().zip(1..) {
                            out.create_element("Item")
                                .with_attributes([
                                    ("name", *name),
                                    ("value", value.to_string().as_str()),
                                    ("description", description),
                                ])
                                .write_empty()?;
                        }
                        Ok(())
                    })?;
                    Ok(())
                })?;
        }
        Ok(())
    })?;
    Ok(())
}

fn log_categories(out: &mut Out) -> io::Result<()> {
    out.create_element("LogCategories").write_inner_content(|out| {
        for (name, description) in CATEGORIES {
            out.create_element("Category")
                .with_attributes([("name", name), ("description", description)])
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

fn scalar(out: &mut Out, position: usize, variable: &Variable) -> io::Result<()> {
    let reference = position.to_string();
    let name = clean(&variable.name);
    let description = clean(&variable.description);
    let mut attributes: Vec<(&str, &str)> = vec![("name", &name), ("valueReference", &reference)];
    if !description.is_empty() {
        attributes.push(("description", &description));
    }
    let variability = match variable.variability {
        Variability::Continuous => "continuous",
        Variability::Discrete => "discrete",
    };
    attributes.extend(match variable.causality {
        Causality::TunableParameter => {
            vec![("causality", "parameter"), ("variability", "tunable"), ("initial", "exact")]
        }
        Causality::Input => vec![("causality", "input"), ("variability", variability)],
        Causality::Output => vec![("causality", "output"), ("variability", variability), ("initial", "calculated")],
    });
    let has_start = variable.causality != Causality::Output;
    out.create_element("ScalarVariable").with_attributes(attributes).write_inner_content(|out| {
        let mut attributes: Vec<(&str, String)> = Vec::new();
        let element = match &variable.kind {
            Kind::Real { start, unit, min } => {
                attributes.extend(unit.iter().map(|unit| ("unit", clean(unit))));
                attributes.extend(min.iter().map(|min| ("min", number(*min))));
                attributes.extend(has_start.then(|| ("start", number(*start))));
                "Real"
            }
            Kind::Integer { start, min, max } => {
                attributes.extend([("min", min.to_string()), ("max", max.to_string())]);
                attributes.extend(has_start.then(|| ("start", start.to_string())));
                "Integer"
            }
            Kind::Enumeration { start, definition } => {
                attributes.push(("declaredType", definition.name.into()));
                attributes.extend(has_start.then(|| ("start", start.to_string())));
                "Enumeration"
            }
            Kind::String { start } => {
                attributes.extend(has_start.then(|| ("start", clean(start))));
                "String"
            }
        };
        out.create_element(element)
            .with_attributes(attributes.iter().map(|(name, value)| (*name, value.as_str())))
            .write_empty()?;
        Ok(())
    })?;
    Ok(())
}

fn model_structure(out: &mut Out, variables: &[Variable]) -> io::Result<()> {
    out.create_element("ModelStructure").write_inner_content(|out| {
        if variables.iter().any(|variable| variable.causality == Causality::Output) {
            unknowns(out, "Outputs", variables, |variable| &variable.feed_through)?;
            unknowns(out, "InitialUnknowns", variables, |variable| &variable.initial_dependencies)?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Dependencies are always written: an absent attribute would mean "on everything".
fn unknowns(
    out: &mut Out,
    element: &str,
    variables: &[Variable],
    dependencies: impl Fn(&Variable) -> &[usize],
) -> io::Result<()> {
    out.create_element(element).write_inner_content(|out| {
        for (index, variable) in (1..).zip(variables).filter(|(_, variable)| variable.causality == Causality::Output) {
            let list: Vec<String> = dependencies(variable).iter().map(|position| (position + 1).to_string()).collect();
            out.create_element("Unknown")
                .with_attributes([("index", index.to_string().as_str()), ("dependencies", &list.join(" "))])
                .write_empty()?;
        }
        Ok(())
    })?;
    Ok(())
}

/// Shortest text that reads back as the same number.
fn number(value: f64) -> String {
    format!("{value:?}")
}

/// Characters that XML 1.0 cannot hold, and line ends in attributes, become blanks.
fn clean(text: &str) -> String {
    text.chars().map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fmi_rs::model_description::fmi2::ModelDescription;
    use overclosure_fmu::backend::law;

    fn law_description() -> String {
        let heading = Heading {
            name: "A & <B>".into(),
            identifier: "A".into(),
            description: "quotes \" and 100 %".into(),
            naming: Naming::Structured,
            stop: 1.0,
            step: 0.01,
        };
        write(&heading, "{1}", &law::variables()).expect("memory")
    }

    #[test]
    fn elements_stand_in_the_order_of_the_schema() {
        let text = law_description();
        let places: Vec<usize> = [
            "<CoSimulation",
            "<UnitDefinitions",
            "<TypeDefinitions",
            "<LogCategories",
            "<DefaultExperiment",
            "<ModelVariables",
            "<ModelStructure",
            "<Outputs",
            "<InitialUnknowns",
        ]
        .iter()
        .map(|element| text.find(element).expect(element))
        .collect();
        assert!(places.is_sorted(), "{places:?}");
    }

    #[test]
    fn an_importer_reads_back_what_was_written() {
        let description = ModelDescription::from_string(&law_description()).expect("parses");
        assert!(description.validate().is_empty(), "{:?}", description.validate());
        assert_eq!(description.modelName, "A & <B>");
        assert_eq!(description.modelVariables.len(), law::variables().len());
        let pressure = description.variable_index_by_name("pressure").expect("there") as u32 + 1;
        let unknown = description.outputs.iter().find(|unknown| unknown.index == pressure).expect("an output");
        assert_eq!(unknown.dependencies.as_deref(), Some(&[1][..]));
    }

    #[test]
    fn starts_lie_within_their_bounds() {
        for variable in law::variables() {
            match variable.kind {
                Kind::Real { start, min, .. } => assert!(min.is_none_or(|min| start >= min), "{}", variable.name),
                Kind::Integer { start, min, max } => assert!((min..=max).contains(&start), "{}", variable.name),
                Kind::Enumeration { start, definition } => {
                    assert!((1..=definition.items.len() as i32).contains(&start), "{}", variable.name);
                }
                Kind::String { .. } => {}
            }
        }
    }
}
