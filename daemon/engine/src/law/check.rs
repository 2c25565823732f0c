//! What every law is held to: derivatives, inverse, finiteness.

use super::PressureLaw;

/// Slope against a central difference of the pressure, pressure against one of the energy.
/// Samples nearer than `step` to a kink are a mistake in the test.
pub(crate) fn check_law(law: &dyn PressureLaw, samples: &[f64], step: f64) {
    for &h in samples {
        assert!(law.kinks().iter().all(|k| (h - k).abs() > step), "sample {h} straddles a kink");
        let (lo, at, hi) = (law.evaluate(h - step), law.evaluate(h), law.evaluate(h + step));
        let width = (h + step) - (h - step);
        assert_close(at.stiffness, (hi.pressure - lo.pressure) / width, 1e-6, 1e-9);
        assert_close(at.pressure, (hi.energy - lo.energy) / width, 1e-6, 1e-9);
    }
}

/// At the samples, all above the onset, `overclosure_at(pressure)` gives the overclosure back; at no pressure the onset.
pub(crate) fn assert_inverse(law: &dyn PressureLaw, samples: &[f64], onset: f64) {
    for &h in samples {
        let p = law.evaluate(h).pressure;
        let span = h.abs().max(onset.abs());
        assert_close(law.overclosure_at(p), h, 0.0, 1e-13 * span);
    }
    for pressure in [0.0, -0.0, -1.0, -1e300] {
        assert_eq!(law.overclosure_at(pressure), onset);
    }
}

/// No infinity and no NaN for any finite argument; pressure never falls, energy and slope are never negative.
pub(crate) fn assert_finite_everywhere(law: &dyn PressureLaw) {
    let mut last = 0.0;
    for h in ladder() {
        let at = law.evaluate(h);
        assert!(at.pressure.is_finite() && at.stiffness.is_finite() && at.energy.is_finite(), "at {h:e}: {at:?}");
        assert!(at.stiffness >= 0.0 && at.energy >= 0.0, "at {h:e}: {at:?}");
        assert!(at.pressure >= last, "the pressure falls at {h:e}");
        last = at.pressure;
        assert!(law.overclosure_at(h).is_finite(), "inverse at {h:e}");
    }
    assert!(last > 0.0, "the law never transmits pressure");
}

/// Numbers of both signs over the whole range of `f64`, ascending.
fn ladder() -> Vec<f64> {
    let mut positive: Vec<f64> = (-307..=308).flat_map(|e| [1.0, 3.3].map(|m| m * 10f64.powi(e))).collect();
    positive.retain(|h| h.is_finite());
    positive.push(f64::MAX);
    let negative = positive.iter().rev().map(|h| -h);
    negative.chain([0.0]).chain(positive.iter().copied()).collect()
}

/// Within an absolute plus a relative tolerance.
pub(crate) fn assert_close(actual: f64, expected: f64, relative: f64, absolute: f64) {
    let allowed = absolute + relative * expected.abs();
    assert!((actual - expected).abs() <= allowed, "{actual} is not {expected} within {allowed:e}");
}
