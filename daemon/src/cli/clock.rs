//! Wall seconds by phase.

use std::collections::BTreeMap;
use std::time::Instant;

use overclosure::simulation::Phase;

/// What a run is doing: reading the deck, or a phase of the engine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Reading the deck.
    Read,
    /// A phase of the engine.
    Phase(Phase),
}

impl Stage {
    /// Increments.
    pub const SOLVE: Self = Self::Phase(Phase::Solve);
    /// Writing results.
    pub const WRITE: Self = Self::Phase(Phase::Write);

    /// Name in the report.
    pub fn name(self) -> &'static str {
        match self {
            Self::Read => "read",
            Self::Phase(phase) => match phase {
                Phase::Search => "search",
                Phase::Assemble => "assemble",
                Phase::Order => "order",
                Phase::Symbolic => "symbolic",
                Phase::Numeric => "numeric",
                Phase::Condense => "condense",
                Phase::Cache => "cache",
                Phase::Solve => "solve",
                Phase::Write => "write",
            },
        }
    }

    /// What a person reads while it goes on.
    pub fn description(self) -> &'static str {
        match self {
            Self::Read => "reading the deck",
            Self::Phase(phase) => match phase {
                Phase::Search => "searching contact",
                Phase::Assemble => "assembling",
                Phase::Order => "ordering",
                Phase::Symbolic => "symbolic factorisation",
                Phase::Numeric => "numeric factorisation",
                Phase::Condense => "condensing onto contact",
                Phase::Cache => "reading or writing the prepared model",
                Phase::Solve => "solving",
                Phase::Write => "writing results",
            },
        }
    }
}

/// Adds up the time spent in each stage.
pub struct Clock {
    stage: Stage,
    since: Instant,
    seconds: BTreeMap<&'static str, f64>,
}

impl Clock {
    /// Begins in a stage.
    pub fn start(stage: Stage) -> Self {
        Self { stage, since: Instant::now(), seconds: BTreeMap::new() }
    }

    /// Ends the present stage and begins another; returns the one that ended.
    pub fn enter(&mut self, stage: Stage) -> Stage {
        let now = Instant::now();
        *self.seconds.entry(self.stage.name()).or_default() += (now - self.since).as_secs_f64();
        self.since = now;
        std::mem::replace(&mut self.stage, stage)
    }

    /// Seconds by name of the stage, the present one included, to the microsecond.
    pub fn seconds(&self) -> BTreeMap<String, f64> {
        let mut seconds: BTreeMap<String, f64> = self.seconds.iter().map(|(n, s)| ((*n).to_owned(), *s)).collect();
        *seconds.entry(self.stage.name().to_owned()).or_default() += self.since.elapsed().as_secs_f64();
        for value in seconds.values_mut() {
            *value = (*value * 1e6).round() / 1e6;
        }
        seconds
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_is_booked_under_the_stage_that_ended() {
        let mut clock = Clock::start(Stage::Read);
        assert_eq!(clock.enter(Stage::SOLVE), Stage::Read);
        assert_eq!(clock.enter(Stage::WRITE), Stage::SOLVE);
        assert_eq!(clock.enter(Stage::SOLVE), Stage::WRITE);
        let seconds = clock.seconds();
        assert_eq!(seconds.keys().map(String::as_str).collect::<Vec<_>>(), ["read", "solve", "write"]);
        assert!(seconds.values().all(|s| *s >= 0.0));
    }
}
