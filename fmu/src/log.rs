//! The log of an instance: finished text, filtered by category.

use crate::status::Status;

/// Categories that `modelDescription.xml` declares.
pub const CATEGORIES: [(&str, &str); 5] = [
    ("logEvents", "Life of the instance: initialisation, steps, states."),
    ("logStatusWarning", "Something a person should look at; the answer stands."),
    ("logStatusError", "Why a call returned fmi2Error."),
    ("logStatusFatal", "Internal errors."),
    ("logAll", "All of the above."),
];

/// Receives finished text: status, category, message without any conversion left to do.
pub type Sink = Box<dyn Fn(Status, &str, &str) + Send>;

/// Filters messages and hands them on.
pub struct Log {
    sink: Option<Sink>,
    on: bool,
    /// Positions in [`CATEGORIES`] that pass; all of them unless the importer chose some.
    passing: [bool; CATEGORIES.len()],
}

impl Log {
    /// A log that writes to `sink` once it is switched on.
    pub fn new(sink: Option<Sink>, on: bool) -> Self {
        Self { sink, on, passing: [true; CATEGORIES.len()] }
    }

    /// Switches logging. No categories given means all. Returns the names that are not known.
    pub fn configure(&mut self, on: bool, categories: &[String]) -> Vec<String> {
        self.on = on;
        let everything = categories.is_empty() || categories.iter().any(|name| name == "logAll");
        self.passing = [everything; CATEGORIES.len()];
        let mut unknown = Vec::new();
        for name in categories {
            match CATEGORIES.iter().position(|(known, _)| known == name) {
                Some(position) => self.passing[position] = true,
                None => unknown.push(name.clone()),
            }
        }
        unknown
    }

    /// Progress, of interest to whoever follows the instance.
    pub fn event(&self, message: impl FnOnce() -> String) {
        self.write(Status::Ok, "logEvents", message);
    }

    /// The answer stands, but somebody should know.
    pub fn warning(&self, message: impl FnOnce() -> String) {
        self.write(Status::Warning, "logStatusWarning", message);
    }

    /// Why a call fails.
    pub fn error(&self, message: impl FnOnce() -> String) {
        self.write(Status::Error, "logStatusError", message);
    }

    /// An internal error.
    pub fn fatal(&self, message: impl FnOnce() -> String) {
        self.write(Status::Fatal, "logStatusFatal", message);
    }

    fn write(&self, status: Status, category: &str, message: impl FnOnce() -> String) {
        let Some(sink) = self.sink.as_ref().filter(|_| self.on) else {
            return;
        };
        let passes = CATEGORIES.iter().zip(self.passing).any(|((name, _), passing)| *name == category && passing);
        if passes {
            sink(status, category, &message());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::{Arc, Mutex};

    fn recording() -> (Log, Arc<Mutex<Vec<String>>>) {
        let seen = Arc::new(Mutex::new(Vec::new()));
        let target = Arc::clone(&seen);
        let sink: Sink = Box::new(move |_, category, message| {
            target.lock().expect("no test panics while writing").push(format!("{category}: {message}"));
        });
        (Log::new(Some(sink), true), seen)
    }

    #[test]
    fn categories_filter() {
        let (mut log, seen) = recording();
        assert!(log.configure(true, &["logStatusError".into()]).is_empty());
        log.event(|| "not seen".into());
        log.error(|| "seen".into());
        assert_eq!(*seen.lock().expect("unpoisoned"), ["logStatusError: seen"]);
    }

    #[test]
    fn unknown_categories_are_returned() {
        let (mut log, _) = recording();
        assert_eq!(log.configure(true, &["logNonsense".into(), "logAll".into()]), ["logNonsense"]);
    }

    #[test]
    fn nothing_is_written_when_logging_is_off() {
        let (mut log, seen) = recording();
        log.configure(false, &[]);
        log.error(|| "not seen".into());
        assert!(seen.lock().expect("unpoisoned").is_empty());
    }
}
