//! Rigid motions in words.

/// A motion in words: `motion` has three translations and three rotations, the latter times the size of the body; the
/// centroid is that of the body.
pub fn in_words(motion: &[f64; 6], centroid: [f64; 3], size: f64) -> String {
    let largest = motion.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let moving: Vec<usize> = (0..6).filter(|&i| motion[i].abs() > 1e-9 * largest).collect();
    match moving[..] {
        [i] if i < 3 => format!("translation along {}", i + 1),
        [i] => format!("rotation about {}", i - 2),
        _ => in_numbers(motion, centroid, size),
    }
}

/// A motion that is not one along or about an axis through the centroid.
fn in_numbers(motion: &[f64; 6], centroid: [f64; 3], size: f64) -> String {
    let (t, w) = (&motion[..3], &motion[3..]);
    let direction = |v: &[f64]| {
        let length = v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let part = |i: usize| round(v[i] / length, 1.0);
        format!("({:.3}, {:.3}, {:.3})", part(0), part(1), part(2))
    };
    if w.iter().map(|x| x * x).sum::<f64>() <= 1e-12 {
        return format!("translation along {}", direction(t));
    }
    let through: [f64; 3] = std::array::from_fn(|i| round(centroid[i] + size * axis_point(t, w, i), size));
    format!(
        "rotation about the direction {} through ({:.4e}, {:.4e}, {:.4e})",
        direction(w),
        through[0],
        through[1],
        through[2]
    )
}

/// Zero instead of a coordinate that is rounding against the size of the body.
fn round(coordinate: f64, size: f64) -> f64 {
    if coordinate.abs() < 1e-9 * size { 0.0 } else { coordinate }
}

/// Point of the axis of a motion nearest to the centroid: `ω x t / ω²`.
fn axis_point(t: &[f64], w: &[f64], i: usize) -> f64 {
    let (j, k) = ((i + 1) % 3, (i + 2) % 3);
    (w[j] * t[k] - w[k] * t[j]) / w.iter().map(|x| x * x).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_along_and_about_axes_are_named() {
        assert_eq!(in_words(&[0.0, 0.0, -2.0, 0.0, 0.0, 1e-12], [0.0; 3], 1.0), "translation along 3");
        assert_eq!(in_words(&[0.0, 0.0, 0.0, 0.0, 3.0, 0.0], [0.0; 3], 1.0), "rotation about 2");
    }

    #[test]
    fn a_rotation_off_the_centroid_is_described_by_its_axis() {
        // About 3 through (1, 0, 0) + centroid, body size 2: t = -w x r.
        let words = in_words(&[0.0, -0.5, 0.0, 0.0, 0.0, 1.0], [5.0, 0.0, 0.0], 2.0);
        assert_eq!(words, "rotation about the direction (0.000, 0.000, 1.000) through (6.0000e0, 0.0000e0, 0.0000e0)");
    }
}
