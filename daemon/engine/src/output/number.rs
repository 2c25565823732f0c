//! Numbers as text.

use std::fmt::Write;

/// Appends `,` and the number with 17 significant digits, which is enough to read the same bits again.
pub(super) fn push_number(row: &mut String, value: f64) {
    // Most entries of a frictionless table are zero and formatting dominates the cost of a row.
    if value.to_bits() == 0 {
        row.push_str(",0.0000000000000000e0");
    } else {
        // Writing to a string does not fail.
        let _ = write!(row, ",{value:.16e}");
    }
}

/// Appends `,` and each number.
pub(super) fn push_numbers(row: &mut String, values: &[f64]) {
    for &value in values {
        push_number(row, value);
    }
}

/// Appends `,` and a name, quoted if it needs to be.
pub(super) fn push_name(row: &mut String, name: &str) {
    row.push(',');
    if name.contains([',', '"', '\n']) {
        row.push('"');
        row.push_str(&name.replace('"', "\"\""));
        row.push('"');
    } else {
        row.push_str(name);
    }
}

/// `-1.234567E-03`, right-aligned in 15 columns: the form of printed tables.
pub(super) fn printed(value: f64) -> String {
    let text = format!("{value:.6E}");
    let (mantissa, exponent) = text.split_once('E').unwrap_or((&text, "0"));
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    format!("{:>15}", format!("{mantissa}E{sign}{digits:0>2}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits() {
        for value in [0.0, -0.0, 1.0, -1.0 / 3.0, f64::MAX, f64::MIN_POSITIVE, 5e-324, 0.1 + 0.2] {
            let mut row = String::new();
            push_number(&mut row, value);
            let read: f64 = row.strip_prefix(',').unwrap().parse().unwrap();
            assert_eq!(read.to_bits(), value.to_bits(), "{row}");
            let digits = row.split('e').next().unwrap().chars().filter(char::is_ascii_digit).count();
            assert_eq!(digits, 17, "{row}");
        }
    }

    #[test]
    fn names_with_commas_are_quoted() {
        let mut row = String::new();
        push_name(&mut row, "CFN1[A,\"B\"]");
        assert_eq!(row, ",\"CFN1[A,\"\"B\"\"]\"");
    }

    #[test]
    fn printed_numbers_have_the_fortran_form() {
        assert_eq!(printed(-0.001234567), "  -1.234567E-03");
        assert_eq!(printed(0.0), "   0.000000E+00");
        assert_eq!(printed(1e100), "  1.000000E+100");
    }
}
