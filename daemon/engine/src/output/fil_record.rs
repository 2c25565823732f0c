//! Records of an ASCII results file: a stream of items, cut into lines of 80 characters.
//!
//! A record begins with `*`, its number of words and its key. Words are whole numbers `I`, two columns with the number of
//! digits, the digits; real numbers `D` and 22 columns with 16 digits (Fortran's `1PD22.15`); text `A` and 8 columns.

use std::fmt::Write;

/// Columns of a line.
const WIDTH: usize = 80;
/// Most words of a record.
pub(super) const WORDS_MAX: usize = 80;

/// A record under construction.
pub(super) struct Record {
    words: usize,
    body: String,
}

impl Record {
    /// With its key.
    pub(super) fn new(key: u32) -> Self {
        // The first word is the number of words.
        let mut record = Self { words: 1, body: String::new() };
        record.push_whole(key);
        record
    }

    fn push_whole(&mut self, value: u32) {
        self.words += 1;
        push_whole(&mut self.body, value as usize);
    }

    /// Appends a whole number.
    pub(super) fn whole(mut self, value: u32) -> Self {
        self.push_whole(value);
        self
    }

    /// Appends whole numbers.
    pub(super) fn wholes(mut self, values: impl IntoIterator<Item = u32>) -> Self {
        values.into_iter().for_each(|value| self.push_whole(value));
        self
    }

    /// Appends real numbers.
    pub(super) fn reals(mut self, values: &[f64]) -> Self {
        for &value in values {
            self.words += 1;
            self.body.push('D');
            self.body.push_str(&real(value));
        }
        self
    }

    /// Appends one word of text: the first eight characters, blanks behind.
    pub(super) fn word(mut self, text: &str) -> Self {
        self.words += 1;
        let plain: String =
            text.chars().map(|c| if c.is_ascii() && !c.is_control() { c } else { '?' }).take(8).collect();
        // Writing to a string does not fail, here and below.
        let _ = write!(self.body, "A{plain:<8}");
        self
    }

    /// Appends text over as many words as it needs, at least `least`.
    pub(super) fn text(mut self, text: &str, least: usize) -> Self {
        let characters: Vec<char> = text.chars().collect();
        let words = characters.len().div_ceil(8).max(least);
        for word in 0..words {
            let piece: String = characters.iter().skip(8 * word).take(8).collect();
            self = self.word(&piece);
        }
        self
    }
}

fn push_whole(text: &mut String, value: usize) {
    let digits = value.to_string();
    let _ = write!(text, "I{:>2}{digits}", digits.len());
}

/// `1PD22.15`: 22 columns. Exponents of three digits take the place of the letter, as Fortran has it.
fn real(value: f64) -> String {
    if !value.is_finite() {
        return format!("{value:>22}");
    }
    let text = format!("{value:.15e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let (sign, digits) = match exponent.strip_prefix('-') {
        Some(digits) => ('-', digits),
        None => ('+', exponent),
    };
    let letter = if digits.len() < 3 { "D" } else { "" };
    format!("{:>22}", format!("{mantissa}{letter}{sign}{digits:0>2}"))
}

/// The lines made from records.
#[derive(Default)]
pub(super) struct Stream {
    text: String,
    /// Columns of the last line that are filled.
    column: usize,
}

impl Stream {
    /// Appends a record.
    pub(super) fn push(&mut self, record: &Record) {
        let mut head = String::from("*");
        push_whole(&mut head, record.words);
        self.characters(&head);
        self.characters(&record.body);
    }

    /// Ends an increment: record 2001 filled up to the end of its line, then a line of blanks.
    pub(super) fn end_increment(&mut self) {
        self.push(&Record::new(2001));
        while self.column != 0 {
            self.characters(" ");
        }
        self.characters(&" ".repeat(WIDTH));
    }

    /// Takes out what there is: whole lines, if an increment has just been ended.
    pub(super) fn take(&mut self) -> String {
        std::mem::take(&mut self.text)
    }

    fn characters(&mut self, characters: &str) {
        for character in characters.chars() {
            self.text.push(character);
            self.column += 1;
            if self.column == WIDTH {
                self.text.push('\n');
                self.column = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(records: &[Record]) -> String {
        let mut stream = Stream::default();
        records.iter().for_each(|record| stream.push(record));
        stream.take()
    }

    #[test]
    fn words_have_the_form_of_the_manual() {
        let node = Record::new(1901).whole(12).reals(&[10.0, 0.0, -1.0 / 3.0]);
        assert_eq!(
            lines(&[node]).replace('\n', ""),
            "*I 16I 41901I 212D 1.000000000000000D+01D 0.000000000000000D+00D-3.333333333333333D-01"
        );
        let element = Record::new(1900).whole(7).word("C3D8").wholes([1, 23]);
        assert_eq!(lines(&[element]), "*I 16I 41900I 17AC3D8    I 11I 223");
        assert_eq!(
            lines(&[Record::new(1940).whole(3).text("SECONDARY_SURFACE", 1)]),
            "*I 16I 41940I 13ASECONDARAY_SURFACAE       "
        );
    }

    #[test]
    fn reals_keep_their_width() {
        for (value, expected) in [
            (1.0, " 1.000000000000000D+00"),
            (-9.999_999_999_999_999e-5, "-9.999999999999999D-05"),
            (1e100, " 1.000000000000000+100"),
            (5e-324, " 4.940656458412465-324"),
            (f64::NAN, "                   NaN"),
        ] {
            assert_eq!(real(value), expected);
            assert_eq!(real(value).len(), 22);
        }
    }

    #[test]
    fn lines_have_eighty_columns_and_an_increment_ends_with_a_blank_one() {
        let mut stream = Stream::default();
        for node in 0..7 {
            stream.push(&Record::new(101).whole(node).reals(&[0.5; 3]));
        }
        stream.end_increment();
        let text = stream.take();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|line| line.len() == 80), "{text}");
        let [.., end, blank] = lines[..] else { panic!("{text}") };
        assert!(end.trim_end().ends_with("*I 12I 42001") && blank.trim().is_empty(), "{text}");
    }
}
