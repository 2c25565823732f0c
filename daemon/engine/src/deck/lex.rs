//! Fields, numbers and names of deck lines.

/// Why a field is not the number it should be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NumberFault {
    /// Not written as a number.
    Unreadable,
    /// Written as a number that no double holds, or as NaN or infinity.
    NotFinite,
    /// Not a label: labels run from 1 to 4294967295.
    NoLabel,
}

impl NumberFault {
    /// The fault as the end of a sentence.
    pub fn text(self) -> &'static str {
        match self {
            Self::Unreadable => "is not a number",
            Self::NotFinite => "is not a finite number",
            Self::NoLabel => "is not a whole number above 0",
        }
    }
}

/// Iterator over the fields of a line: split at commas outside double quotes, blanks around them removed.
/// The empty field behind a trailing comma is not given.
#[derive(Clone)]
pub struct Fields<'a> {
    rest: Option<&'a [u8]>,
}

/// Fields of a line.
pub fn fields(line: &[u8]) -> Fields<'_> {
    Fields { rest: Some(line) }
}

impl<'a> Iterator for Fields<'a> {
    type Item = &'a [u8];

    fn next(&mut self) -> Option<&'a [u8]> {
        let rest = self.rest?;
        let mut quoted = false;
        for (i, &byte) in rest.iter().enumerate() {
            if byte == b',' && !quoted {
                let (field, tail) = (&rest[..i], &rest[i + 1..]);
                self.rest = Some(tail).filter(|tail| !tail.trim_ascii().is_empty());
                return Some(field.trim_ascii());
            }
            quoted ^= byte == b'"';
        }
        self.rest = None;
        Some(rest.trim_ascii())
    }
}

/// Whether the last thing on the line is a comma: then the line goes on below.
pub fn ends_with_comma(line: &[u8]) -> bool {
    line.trim_ascii_end().last() == Some(&b',')
}

/// A real: `1.e7`, `1d5`, `-1.49012e-08`, `5`.
pub fn real(field: &[u8]) -> Result<f64, NumberFault> {
    let digits = field.strip_prefix(b"-").or(field.strip_prefix(b"+")).unwrap_or(field);
    if !digits.first().is_some_and(|&b| b.is_ascii_digit() || b == b'.') {
        let lower = digits.to_ascii_lowercase();
        let not_finite = matches!(lower.as_slice(), b"nan" | b"inf" | b"infinity");
        return Err(if not_finite { NumberFault::NotFinite } else { NumberFault::Unreadable });
    }
    let text = std::str::from_utf8(field).map_err(|_| NumberFault::Unreadable)?;
    let value = match text.parse::<f64>() {
        Ok(value) => value,
        Err(_) => text.replace(['d', 'D'], "e").parse::<f64>().map_err(|_| NumberFault::Unreadable)?,
    };
    if value.is_finite() { Ok(value) } else { Err(NumberFault::NotFinite) }
}

/// A label: a whole number from 1 on.
pub fn label(field: &[u8]) -> Result<u32, NumberFault> {
    let mut value: u32 = 0;
    for &byte in field {
        let digit = byte.wrapping_sub(b'0');
        if digit > 9 {
            return Err(NumberFault::NoLabel);
        }
        value = value.checked_mul(10).and_then(|v| v.checked_add(u32::from(digit))).ok_or(NumberFault::NoLabel)?;
    }
    if value == 0 { Err(NumberFault::NoLabel) } else { Ok(value) }
}

/// Whether a field is meant as a number rather than a name.
pub fn looks_numeric(field: &[u8]) -> bool {
    field.first().is_some_and(|&b| b.is_ascii_digit() || matches!(b, b'+' | b'-' | b'.'))
}

/// A name without the quotes around it.
pub fn unquoted(name: &str) -> &str {
    name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(name).trim()
}

/// What two spellings of one name or word have in common: upper case, no blanks, no quotes.
pub fn key(name: &str) -> String {
    unquoted(name.trim()).chars().filter(|c| !c.is_whitespace()).flat_map(char::to_uppercase).collect()
}

/// The candidate most like a misspelt word, when one is near enough to be meant.
pub fn nearest<'a>(word: &str, candidates: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    const LENGTH_MAX: usize = 40;
    const CANDIDATES_MAX: usize = 5_000;
    let word: Vec<char> = key(word).chars().take(LENGTH_MAX).collect();
    let near = |candidate: &'a str| {
        let other: Vec<char> = key(candidate).chars().take(LENGTH_MAX).collect();
        let allowed = (word.len().max(other.len()) / 3).max(1);
        (word.len().abs_diff(other.len()) <= allowed)
            .then(|| (edit_distance(&word, &other), candidate))
            .filter(|&(distance, _)| distance <= allowed)
    };
    let nearest = candidates.into_iter().take(CANDIDATES_MAX).filter_map(near).min_by_key(|&(distance, _)| distance);
    nearest.map(|(_, candidate)| candidate)
}

/// Fewest insertions, deletions, replacements and exchanges of neighbours that turn one word into the other.
fn edit_distance(a: &[char], b: &[char]) -> usize {
    let mut rows: Vec<Vec<usize>> = vec![(0..=b.len()).collect()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let replaced = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = replaced.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn split(line: &str) -> Vec<String> {
        fields(line.as_bytes()).map(|f| String::from_utf8_lossy(f).into_owned()).collect()
    }

    #[test]
    fn fields_are_split_at_commas_outside_quotes() {
        assert_eq!(split(" 1 ,\t2,3, "), ["1", "2", "3"]);
        assert_eq!(split("1,,3"), ["1", "", "3"]);
        assert_eq!(split("\"a, b\",2"), ["\"a, b\"", "2"]);
        assert_eq!(split(","), [""]);
        assert_eq!(split("7321, 1, , "), ["7321", "1", ""]);
    }

    #[test]
    fn reals_of_every_spelling_are_read() {
        let cases =
            [("1.e7", 1e7), ("1d5", 1e5), ("1.5D-3", 1.5e-3), ("-1.49012e-08", -1.49012e-8), (".5", 0.5), ("+2", 2.0)];
        for (text, value) in cases {
            assert_eq!(real(text.as_bytes()), Ok(value), "{text}");
        }
    }

    #[test]
    fn what_is_not_a_finite_number_is_refused() {
        for text in ["", "x", "1 2", "1..2", "0x10", "e5", "--1", "\u{661}"] {
            assert_eq!(real(text.as_bytes()), Err(NumberFault::Unreadable), "{text}");
        }
        for text in ["nan", "-inf", "Infinity", "1e999"] {
            assert_eq!(real(text.as_bytes()), Err(NumberFault::NotFinite), "{text}");
        }
        for text in ["0", "-1", "1.", "4294967296", "9a"] {
            assert_eq!(label(text.as_bytes()), Err(NumberFault::NoLabel), "{text}");
        }
        assert_eq!(label(b"4294967295"), Ok(u32::MAX));
    }

    #[test]
    fn spellings_share_a_key() {
        assert_eq!(key("\"My Set\" "), key("MYSET"));
        assert_eq!(key("pressure-overclosure"), "PRESSURE-OVERCLOSURE");
    }

    #[test]
    fn the_nearest_name_is_found() {
        assert_eq!(nearest("NTPO", ["NBOT", "NTOP", "OTHER"]), Some("NTOP"));
        assert_eq!(nearest("*SURFACE BEHAVIOUR", ["*SURFACE", "*SURFACE BEHAVIOR"]), Some("*SURFACE BEHAVIOR"));
        assert_eq!(nearest("XYZZY", ["NBOT"]), None);
    }
}
