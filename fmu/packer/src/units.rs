//! Units in terms of SI base units, as `modelDescription.xml` wants them.

/// A unit: its value in SI is `factor` times kg^kg m^m s^s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SiUnit {
    /// Value of one unit in SI.
    pub factor: f64,
    /// Exponent of kg.
    pub kg: i8,
    /// Exponent of m.
    pub m: i8,
    /// Exponent of s.
    pub s: i8,
}

/// Symbols and prefixed symbols that are understood, alone and in products, quotients and powers.
const SYMBOLS: &[(&str, f64, [i8; 3])] = &[
    ("1", 1.0, [0, 0, 0]),
    ("kg", 1.0, [1, 0, 0]),
    ("g", 1e-3, [1, 0, 0]),
    ("t", 1e3, [1, 0, 0]),
    ("m", 1.0, [0, 1, 0]),
    ("cm", 1e-2, [0, 1, 0]),
    ("mm", 1e-3, [0, 1, 0]),
    ("um", 1e-6, [0, 1, 0]),
    ("µm", 1e-6, [0, 1, 0]),
    ("nm", 1e-9, [0, 1, 0]),
    ("in", 0.0254, [0, 1, 0]),
    ("ft", 0.3048, [0, 1, 0]),
    ("s", 1.0, [0, 0, 1]),
    ("ms", 1e-3, [0, 0, 1]),
    ("min", 60.0, [0, 0, 1]),
    ("h", 3600.0, [0, 0, 1]),
    ("N", 1.0, [1, 1, -2]),
    ("mN", 1e-3, [1, 1, -2]),
    ("kN", 1e3, [1, 1, -2]),
    ("MN", 1e6, [1, 1, -2]),
    ("lbf", 4.4482216152605, [1, 1, -2]),
    ("Pa", 1.0, [1, -1, -2]),
    ("kPa", 1e3, [1, -1, -2]),
    ("MPa", 1e6, [1, -1, -2]),
    ("GPa", 1e9, [1, -1, -2]),
    ("bar", 1e5, [1, -1, -2]),
    ("psi", 6894.757293168361, [1, -1, -2]),
    ("J", 1.0, [1, 2, -2]),
    ("mJ", 1e-3, [1, 2, -2]),
    ("kJ", 1e3, [1, 2, -2]),
    ("W", 1.0, [1, 2, -3]),
    ("mW", 1e-3, [1, 2, -3]),
    ("kW", 1e3, [1, 2, -3]),
];

/// Reads `mm`, `N/mm2`, `N.mm`, `mm/s^2`, …: factors separated by `.` or `*`, one optional `/` before the last ones.
/// `None` when a symbol is unknown: the unit then goes into the description without a definition in SI.
pub fn parse(text: &str) -> Option<SiUnit> {
    let mut unit = SiUnit { factor: 1.0, kg: 0, m: 0, s: 0 };
    let (above, below) = text.split_once('/').unwrap_or((text, "1"));
    for (part, sign) in [(above, 1), (below, -1)] {
        for factor in part.trim_matches(|c| c == '(' || c == ')').split(['.', '*']) {
            multiply(&mut unit, factor.trim(), sign)?;
        }
    }
    Some(unit)
}

fn multiply(unit: &mut SiUnit, text: &str, sign: i8) -> Option<()> {
    let symbol_end = match text {
        "1" => 1,
        _ => text.find(|c: char| c.is_ascii_digit() || c == '^' || c == '-').unwrap_or(text.len()),
    };
    let (symbol, power) = text.split_at(symbol_end);
    let power: i8 = match power.trim_start_matches('^') {
        "" => 1,
        digits => digits.parse().ok().filter(|power: &i8| (-9..=9).contains(power))?,
    };
    let (_, factor, [kg, m, s]) = SYMBOLS.iter().find(|(name, ..)| *name == symbol)?;
    let power = power * sign;
    unit.factor *= factor.powi(power.into());
    unit.kg += kg * power;
    unit.m += m * power;
    unit.s += s * power;
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_quotients_and_powers_are_understood() {
        for (text, factor, exponents) in [
            ("m", 1.0, [0, 1, 0]),
            ("Pa/m", 1.0, [1, -2, -2]),
            ("J/m2", 1.0, [1, 0, -2]),
            ("N/mm2", 1e6, [1, -1, -2]),
            ("N/mm^2", 1e6, [1, -1, -2]),
            ("N.mm", 1e-3, [1, 2, -2]),
            ("mm/s2", 1e-3, [0, 1, -2]),
            ("mm2", 1e-6, [0, 2, 0]),
            ("1", 1.0, [0, 0, 0]),
            ("1/s", 1.0, [0, 0, -1]),
        ] {
            let unit = parse(text).expect(text);
            assert!((unit.factor / factor - 1.0).abs() < 1e-12, "{text}: {unit:?}");
            assert_eq!([unit.kg, unit.m, unit.s], exponents, "{text}");
        }
    }

    #[test]
    fn unknown_symbols_are_left_undefined() {
        for text in ["furlong", "N/furlong", "", "mm^x"] {
            assert_eq!(parse(text), None, "{text}");
        }
    }
}
