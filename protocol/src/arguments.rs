//! Requests written as selector parameters, so that a stock tool needs no payload:
//! `overclosure/v1/*/law?kind=exponential;c0=0.01;p0=5;at=-0.005,0,0.01`.
//!
//! Parameters are separated by `;`, names from values by the first `=`. Every name must be known.

use crate::fault::{Fault, FaultCode};
use crate::message::{FieldRequest, GetRequest, InputValue, LawRequest, Parameter, StepRequest};

/// `name=value` pairs of a selector. Names that start with an underscore belong to zenoh and are left out.
pub fn pairs(parameters: &str) -> Vec<(&str, &str)> {
    parameters
        .split(';')
        .filter(|p| !p.is_empty())
        .map(|p| p.split_once('=').unwrap_or((p, "")))
        .filter(|(name, _)| !name.starts_with('_'))
        .collect()
}

fn bad(message: String) -> Fault {
    Fault::new(FaultCode::BadRequest, message)
}

fn number(name: &str, text: &str) -> Result<f64, Fault> {
    text.trim().parse().map_err(|_| bad(format!("{name}: {text:?} is not a number")))
}

/// Overclosures from `h1,h2,...` or `FROM:TO:STEP` (both ends included); at most `points_max` of them.
pub fn overclosures(text: &str, points_max: usize) -> Result<Vec<f64>, Fault> {
    let limit = |count: String| {
        let mut fault = Fault::new(
            FaultCode::LimitExceeded,
            format!("at: {count} overclosures are more than the {points_max} allowed in one request"),
        );
        fault.details.limit = Some(points_max as u64);
        fault
    };
    let parts: Vec<&str> = text.splitn(4, ':').collect();
    match parts.as_slice() {
        [from, to, step] => {
            let (from, to, step) = (number("at", from)?, number("at", to)?, number("at", step)?);
            if !(from.is_finite() && to.is_finite() && step.is_finite() && step != 0.0 && (to - from) / step >= 0.0) {
                return Err(bad(format!(
                    "at: {text:?} is no range; write FROM:TO:STEP with a step that leads from FROM to TO"
                )));
            }
            // The end counts as reached when it is missed by rounding alone, as in 0.3 = 3 * 0.1.
            let count = ((to - from) / step * (1.0 + 1e-12) + 1e-9).floor() + 1.0;
            if count > points_max as f64 {
                return Err(limit(format!("{count:.0}")));
            }
            Ok((0..count as usize).map(|i| from + i as f64 * step).collect())
        }
        [list] => {
            let count = list.split(',').count();
            if count > points_max {
                return Err(limit(count.to_string()));
            }
            list.split(',').map(|h| number("at", h)).collect()
        }
        _ => Err(bad(format!("at: {text:?} is neither h1,h2,... nor FROM:TO:STEP"))),
    }
}

/// `kind=...;at=...` and the parameters of the law.
pub fn law(parameters: &str, points_max: usize) -> Result<LawRequest, Fault> {
    let mut request = LawRequest::default();
    let mut at = None;
    for (name, value) in pairs(parameters) {
        match name {
            "kind" => request.kind = value.to_owned(),
            "at" => at = Some(overclosures(value, points_max)?),
            _ => request.parameters.push(Parameter { name: name.to_owned(), value: value.to_owned() }),
        }
    }
    if request.kind.is_empty() {
        return Err(bad("kind is missing; write e.g. ?kind=linear;stiffness=1e6;at=0,0.01".into()));
    }
    request.overclosure =
        at.ok_or_else(|| bad("at is missing; write e.g. at=-0.005,0,0.01 or at=FROM:TO:STEP".into()))?;
    Ok(request)
}

/// `sequence=...;time=...;frames=U,CPRESS`; every other name is an input.
pub fn step(parameters: &str) -> Result<StepRequest, Fault> {
    let mut request = StepRequest::default();
    let (mut sequence, mut time) = (None, None);
    for (name, value) in pairs(parameters) {
        match name {
            "sequence" => {
                sequence =
                    Some(value.trim().parse().map_err(|_| bad(format!("sequence: {value:?} is not a whole number")))?)
            }
            "time" => time = Some(number(name, value)?),
            "frames" => request.frames = value.split(',').map(|f| f.trim().to_owned()).collect(),
            _ => request.inputs.push(InputValue { name: name.to_owned(), value: number(name, value)? }),
        }
    }
    request.sequence = sequence.ok_or_else(|| bad("sequence is missing; the verb get tells the next one".into()))?;
    request.time = time.ok_or_else(|| bad("time is missing: the total time to reach".into()))?;
    Ok(request)
}

/// `names=a,b`; nothing means all.
pub fn get(parameters: &str) -> Result<GetRequest, Fault> {
    let mut request = GetRequest::default();
    for (name, value) in pairs(parameters) {
        match name {
            "names" => request.names = value.split(',').map(|n| n.trim().to_owned()).collect(),
            _ => return Err(bad(format!("get has no argument {name}; it has names=a,b"))),
        }
    }
    Ok(request)
}

/// `name=CPRESS`.
pub fn field(parameters: &str) -> Result<FieldRequest, Fault> {
    match pairs(parameters).as_slice() {
        [("name", name)] => Ok(FieldRequest { name: (*name).to_owned() }),
        _ => Err(bad("field needs the one argument name, e.g. ?name=CPRESS".into())),
    }
}

/// For verbs without arguments.
pub fn none(parameters: &str, verb: &str) -> Result<(), Fault> {
    match pairs(parameters).first() {
        None => Ok(()),
        Some((name, _)) => Err(bad(format!("{verb} has no argument {name}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_law_is_read_from_a_selector() {
        let request = law("kind=exponential;c0=0.01;p0=5;at=-0.005,0,0.01", 10).expect("a good selector");
        assert_eq!(request.kind, "exponential");
        assert_eq!(request.parameters.len(), 2);
        assert_eq!(request.overclosure, [-0.005, 0.0, 0.01]);
    }

    #[test]
    fn a_range_includes_both_ends() {
        assert_eq!(overclosures("0:0.3:0.1", 10).expect("a range").len(), 4);
        assert_eq!(overclosures("1:0:-0.5", 10).expect("a falling range"), [1.0, 0.5, 0.0]);
    }

    #[test]
    fn a_range_is_bounded_before_it_is_built() {
        for text in ["0:1e300:1e-300", "0:1:1e-12", "0,1,2,3,4,5,6,7,8,9,10"] {
            let fault = overclosures(text, 10).expect_err("too many");
            assert_eq!((fault.code, fault.details.limit), (FaultCode::LimitExceeded, Some(10)), "{text}");
        }
    }

    #[test]
    fn nonsense_is_named() {
        for text in [
            "at=0",
            "kind=linear",
            "kind=linear;at=a",
            "kind=linear;at=0:1",
            "kind=linear;at=0:1:0",
            "kind=linear;at=0:1:-1",
            "kind=linear;at=0:1:1:1",
        ] {
            assert_eq!(law(text, 10).expect_err("refused").code, FaultCode::BadRequest, "{text}");
        }
        assert!(step("time=1").is_err() && step("sequence=1").is_err() && step("sequence=x;time=1").is_err());
        assert!(get("nmaes=a").is_err() && field("").is_err() && none("x=1", "ports").is_err());
    }

    #[test]
    fn other_names_of_a_step_are_inputs() {
        let request =
            step("sequence=3;time=0.5;boundary.NTOP.3=-0.1;frames=U,CPRESS;_time=[now()]").expect("a good selector");
        assert_eq!((request.sequence, request.time), (3, 0.5));
        assert_eq!(request.inputs, [InputValue { name: "boundary.NTOP.3".into(), value: -0.1 }]);
        assert_eq!(request.frames, ["U", "CPRESS"]);
    }
}
