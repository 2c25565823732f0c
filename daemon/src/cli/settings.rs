//! `--set PORT=VALUE`.

use overclosure::port::Port;
use overclosure::simulation::Simulation;

use super::open::WHAT_BECOMES_AN_INPUT;
use super::{Exit, complain};

/// A value for an input.
#[derive(Debug, PartialEq)]
pub struct Setting {
    /// Position of the input.
    pub input: usize,
    /// As the user wrote it.
    pub name: String,
    /// Magnitude that replaces the deck's.
    pub value: f64,
}

/// `PORT=VALUE` taken apart; the value is the text and why it is no number, if it is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Assignment {
    name: String,
    value: Result<f64, String>,
}

/// Takes every text apart.
pub fn parse(texts: &[String]) -> Vec<Assignment> {
    texts
        .iter()
        .map(|text| match text.rsplit_once('=') {
            None => Assignment { name: text.clone(), value: Err("not of the form PORT=VALUE".into()) },
            Some((name, value)) => Assignment {
                name: name.trim().to_owned(),
                value: match value.trim().parse::<f64>() {
                    Ok(value) if value.is_finite() => Ok(value),
                    Ok(_) | Err(_) => Err(format!("{:?} is not a finite number", value.trim())),
                },
            },
        })
        .collect()
}

/// Finds the inputs by name; every fault is told, with the inputs that there are.
pub fn resolve(assignments: &[Assignment], inputs: &[Port]) -> Result<Vec<Setting>, Exit> {
    let (settings, complaints) = find(assignments, inputs);
    if complaints.is_empty() {
        return Ok(settings);
    }
    for complaint in complaints {
        complain(&format!("error: --set {complaint}"));
    }
    let names: Vec<&str> = inputs.iter().map(|p| p.name.as_str()).collect();
    complain(&if names.is_empty() {
        format!("this deck has no inputs; {WHAT_BECOMES_AN_INPUT}")
    } else {
        format!("the inputs of this deck are {}", names.join(", "))
    });
    Err(Exit::InputWrong)
}

/// Gives every input its value.
pub fn apply(settings: Vec<Setting>, simulation: &mut Simulation) -> Result<(), Exit> {
    for Setting { input, name, value } in settings {
        // The names were found among the inputs and the values are finite.
        if let Err(error) = simulation.set_magnitude(input, value) {
            complain(&format!("error: --set {name}: {error}"));
            return Err(Exit::OurFailure);
        }
    }
    Ok(())
}

fn find(assignments: &[Assignment], inputs: &[Port]) -> (Vec<Setting>, Vec<String>) {
    let (mut settings, mut complaints) = (Vec::<Setting>::new(), Vec::new());
    for Assignment { name, value } in assignments.iter().cloned() {
        // Deck names do not depend on case; an exact match goes first.
        let input = inputs
            .iter()
            .position(|p| p.name == name)
            .or_else(|| inputs.iter().position(|p| p.name.eq_ignore_ascii_case(&name)));
        if input.is_none() {
            complaints.push(format!("{name}: no such input"));
        }
        match (input, value) {
            (_, Err(complaint)) => complaints.push(format!("{name}: {complaint}")),
            (Some(input), Ok(_)) if settings.iter().any(|s| s.input == input) => {
                complaints.push(format!("{name}: given more than once"));
            }
            (Some(input), Ok(value)) => settings.push(Setting { input, name, value }),
            (None, Ok(_)) => {}
        }
    }
    (settings, complaints)
}

#[cfg(test)]
mod tests {
    use super::*;
    use overclosure::port::Quantity;

    fn inputs() -> Vec<Port> {
        let port =
            |name: &str| Port { name: name.into(), quantity: Quantity::Length, unit: None, description: String::new() };
        vec![port("boundary.NTOP.3"), port("cload.REF.1")]
    }

    fn found(texts: &[&str]) -> (Vec<Setting>, Vec<String>) {
        find(&parse(&texts.iter().map(|t| (*t).to_owned()).collect::<Vec<_>>()), &inputs())
    }

    #[test]
    fn values_find_their_inputs() {
        let (settings, complaints) = found(&["cload.REF.1=-2.5e3", "boundary.ntop.3 = 0"]);
        assert!(complaints.is_empty(), "{complaints:?}");
        let expected = [(1, -2500.0), (0, 0.0)];
        assert_eq!(settings.iter().map(|s| (s.input, s.value)).collect::<Vec<_>>(), expected);
    }

    #[test]
    fn every_fault_is_found() {
        let (_, complaints) =
            found(&["x=1", "cload.REF.1=abc", "boundary.NTOP.3", "cload.REF.1=1", "cload.ref.1=2", "y=nan"]);
        assert_eq!(complaints.len(), 6, "{complaints:?}");
    }
}
