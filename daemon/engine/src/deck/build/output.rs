//! Output requests. They hold from step to step until a step asks anew for the same kind.

use crate::model::{
    ContactRequest, Dialect, ElementRequest, NodeRequest, OutputRequests, OutputTarget, RestartFrequency,
    RestartRequest, SetId, Totals,
};

use super::super::card::Card;
use super::super::lex::{fields, key};
use super::super::report::{Report, excerpt};
use super::Builder;
use super::layout::StepCards;

/// The three ways to ask.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Family {
    Print,
    File,
    /// Below `*OUTPUT`.
    Database,
}

/// Requests in force.
#[derive(Default)]
pub struct Requests {
    nodes: Vec<(Family, NodeRequest)>,
    elements: Vec<(Family, ElementRequest)>,
    contacts: Vec<(Family, ContactRequest)>,
    snapshots: Option<Snapshots>,
}

/// The `*RESTART, WRITE` in force.
#[derive(Clone, Copy)]
struct Snapshots {
    /// Every how many increments, or every how many steps.
    frequency: u32,
    overlay: bool,
    /// Steps since the request, this one included.
    steps: u32,
}

/// What is asked for, by the second word of the keyword.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Subject {
    Nodes,
    Elements,
    Contacts,
}

/// Variables that are written, in the spelling of the decks, and what a request without variables means.
const NODE_VARIABLES: [&str; 8] = ["U", "RF", "U1", "U2", "U3", "RF1", "RF2", "RF3"];
const ELEMENT_VARIABLES: [&str; 8] = ["S", "S11", "S22", "S33", "S12", "S13", "S23", "MISES"];
const CONTACT_VARIABLES: [&str; 18] = [
    "CSTR", "CSTRESS", "CPRESS", "CSHEAR1", "CSHEAR2", "CDIS", "CDISP", "COPEN", "CSLIP1", "CSLIP2", "CFN", "CFN1",
    "CFN2", "CFN3", "CFNM", "CAREA", "CSTATUS", "CF",
];

impl Subject {
    fn variables(self) -> &'static [&'static str] {
        match self {
            Self::Nodes => &NODE_VARIABLES,
            Self::Elements => &ELEMENT_VARIABLES,
            Self::Contacts => &CONTACT_VARIABLES,
        }
    }

    /// Name of the variable that a component belongs to: tables have all components.
    fn whole(self, word: &str) -> String {
        match self {
            Self::Nodes => word.trim_end_matches(|c: char| c.is_ascii_digit()).into(),
            Self::Elements => "S".into(),
            Self::Contacts => word.into(),
        }
    }

    fn preselected(self) -> Vec<String> {
        let names: &[&str] = match self {
            Self::Nodes => &["U", "RF"],
            Self::Elements => &["S"],
            Self::Contacts => &["CSTRESS", "CDISP"],
        };
        names.iter().map(|name| name.to_string()).collect()
    }
}

/// The `*OUTPUT` that holds for the keywords below it.
#[derive(Clone, Copy)]
struct Database {
    target: OutputTarget,
    frequency: u32,
}

impl Requests {
    /// All requests in force.
    pub fn all(&self, dialect: Dialect) -> OutputRequests {
        OutputRequests {
            nodes: self.nodes.iter().map(|(_, request)| request.clone()).collect(),
            elements: self.elements.iter().map(|(_, request)| request.clone()).collect(),
            contacts: self.contacts.iter().map(|(_, request)| request.clone()).collect(),
            restart: self.snapshots.and_then(|snapshots| snapshots.in_step(dialect)),
        }
    }

    /// Number of requests in force.
    pub fn len(&self) -> usize {
        self.nodes.len() + self.elements.len() + self.contacts.len()
    }

    fn clear(&mut self, family: Family, subject: Subject) {
        match subject {
            Subject::Nodes => self.nodes.retain(|(other, _)| *other != family),
            Subject::Elements => self.elements.retain(|(other, _)| *other != family),
            Subject::Contacts => self.contacts.retain(|(other, _)| *other != family),
        }
    }
}

impl Snapshots {
    /// What the request means in this step: Abaqus counts increments, CalculiX counts steps.
    fn in_step(self, dialect: Dialect) -> Option<RestartRequest> {
        let frequency = match dialect {
            Dialect::Abaqus => RestartFrequency::Increments(self.frequency),
            Dialect::Calculix if self.steps.is_multiple_of(self.frequency) => RestartFrequency::StepEnd,
            Dialect::Calculix => return None,
        };
        Some(RestartRequest { frequency, overlay: self.overlay })
    }
}

impl Builder<'_> {
    /// Takes a `*RESTART` into the requests in force.
    pub(super) fn restart_request(&mut self, card: &Card, requests: &mut Requests) {
        if card.faulty {
            return;
        }
        if !card.parameters.has("WRITE") {
            let remedy = "write *RESTART, WRITE; to go on from a snapshot: overclosure run DECK --restart FILE";
            self.report.error(card.at, card.keyword.name, "parameter WRITE is missing", remedy);
            return;
        }
        let frequency = self.frequency(card);
        let overlay = card.parameters.has("OVERLAY");
        requests.snapshots = (frequency > 0).then_some(Snapshots { frequency, overlay, steps: 0 });
    }

    /// Takes the requests of a step into those in force.
    pub(super) fn output_requests(&mut self, step: &StepCards<'_>, requests: &mut Requests) {
        for card in step.cards.iter().filter(|card| card.keyword.name == "*RESTART") {
            self.restart_request(card, requests);
        }
        if let Some(snapshots) = &mut requests.snapshots {
            snapshots.steps += 1;
        }
        let mut database = None;
        let mut database_begun = false;
        let mut begun: Vec<(Family, Subject)> = Vec::new();
        for card in &step.cards {
            let (family, subject) = match card.keyword.name {
                "*OUTPUT" => {
                    if !database_begun && card.parameters.word("OP") != "ADD" {
                        for subject in [Subject::Nodes, Subject::Elements, Subject::Contacts] {
                            requests.clear(Family::Database, subject);
                        }
                    }
                    database_begun = true;
                    database = Some(self.database(card, requests));
                    continue;
                }
                "*NODE PRINT" => (Family::Print, Subject::Nodes),
                "*NODE FILE" => (Family::File, Subject::Nodes),
                "*NODE OUTPUT" => (Family::Database, Subject::Nodes),
                "*EL PRINT" => (Family::Print, Subject::Elements),
                "*EL FILE" => (Family::File, Subject::Elements),
                "*ELEMENT OUTPUT" => (Family::Database, Subject::Elements),
                "*CONTACT PRINT" => (Family::Print, Subject::Contacts),
                "*CONTACT FILE" => (Family::File, Subject::Contacts),
                "*CONTACT OUTPUT" => (Family::Database, Subject::Contacts),
                _ => continue,
            };
            let (target, frequency) = match (family, database) {
                (Family::Print, _) => (OutputTarget::Print, self.frequency(card)),
                (Family::File, _) => (OutputTarget::Field, self.frequency(card)),
                (Family::Database, Some(database)) => (database.target, database.frequency),
                (Family::Database, None) => {
                    self.report.warning(
                        card.at,
                        card.keyword.name,
                        "there is no *OUTPUT above it: read as field output",
                        "write *OUTPUT, FIELD above it",
                    );
                    (OutputTarget::Field, 1)
                }
            };
            if family != Family::Database && !begun.contains(&(family, subject)) {
                begun.push((family, subject));
                requests.clear(family, subject);
            }
            self.request(card, (family, subject), target, frequency, requests);
        }
    }

    fn request(
        &mut self,
        card: &Card,
        (family, subject): (Family, Subject),
        target: OutputTarget,
        frequency: u32,
        requests: &mut Requests,
    ) {
        let variables = variables(card, subject, self.report);
        if variables.is_empty() {
            return;
        }
        match subject {
            Subject::Nodes => {
                let Ok(set) = self.optional_set(card, "NSET") else { return };
                let totals = match card.parameters.word("TOTALS").as_str() {
                    "ONLY" => Totals::Only,
                    "YES" => Totals::Yes,
                    "" if card.parameters.has("TOTALS") => Totals::Yes,
                    _ => Totals::No,
                };
                requests.nodes.push((family, NodeRequest { target, set, variables, frequency, totals }));
            }
            Subject::Elements => {
                let Ok(set) = self.optional_set(card, "ELSET") else { return };
                requests.elements.push((family, ElementRequest { target, set, variables, frequency }));
            }
            Subject::Contacts => requests.contacts.push((family, ContactRequest { target, variables, frequency })),
        }
    }

    /// Set of a request: `Err` when it names one that does not exist, which is reported.
    fn optional_set(&mut self, card: &Card, parameter: &str) -> Result<Option<SetId>, ()> {
        let names = if parameter == "NSET" { &mut self.node_sets } else { &mut self.element_sets };
        match card.parameters.value(parameter) {
            None => Ok(None),
            Some(name) => {
                names.refer(name, card.at, card.keyword.name, self.report).map(|set| Some(SetId(set))).ok_or(())
            }
        }
    }

    fn frequency(&mut self, card: &Card) -> u32 {
        let Some(text) = card.parameters.value("FREQUENCY") else { return 1 };
        text.parse().unwrap_or_else(|_| {
            let message = format!("FREQUENCY={} is not a whole number", excerpt(text.as_bytes()));
            self.report.error(
                card.at,
                card.keyword.name,
                message,
                "write every how many increments to write, 0 for never",
            );
            1
        })
    }

    fn database(&mut self, card: &Card, requests: &mut Requests) -> Database {
        let target = match (card.parameters.has("FIELD"), card.parameters.has("HISTORY")) {
            (false, true) => OutputTarget::History,
            (true, true) => {
                self.report.error(card.at, "*OUTPUT", "FIELD and HISTORY exclude each other", "write two *OUTPUT");
                OutputTarget::Field
            }
            _ => OutputTarget::Field,
        };
        let frequency = self.frequency(card);
        if card.parameters.has("VARIABLE") && target == OutputTarget::Field {
            let (family, target) = (Family::Database, OutputTarget::Field);
            let node = NodeRequest {
                target,
                set: None,
                variables: Subject::Nodes.preselected(),
                frequency,
                totals: Totals::No,
            };
            let element = ElementRequest { target, set: None, variables: Subject::Elements.preselected(), frequency };
            let contact = ContactRequest { target, variables: Subject::Contacts.preselected(), frequency };
            requests.nodes.push((family, node));
            requests.elements.push((family, element));
            requests.contacts.push((family, contact));
        }
        Database { target, frequency }
    }
}

/// Variables of a request that are written; others are reported.
fn variables(card: &Card, subject: Subject, report: &mut Report) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut named = false;
    for line in card.lines().iter() {
        for field in fields(line.text.as_bytes()).filter(|field| !field.is_empty()) {
            named = true;
            let word = key(&String::from_utf8_lossy(field));
            if matches!(word.as_str(), "PRESELECT" | "ALL") {
                found.extend(subject.preselected());
            } else if !subject.variables().contains(&word.as_str()) {
                let message = format!("{} is not written", excerpt(field));
                let remedy = format!("variables are {}", subject.variables().join(", "));
                report.warning(line.at, card.keyword.name, message, remedy);
            } else if let Some(name) = Some(subject.whole(&word)).filter(|name| !found.contains(name)) {
                found.push(name);
            }
        }
    }
    if !named {
        if subject != Subject::Contacts && !card.parameters.has("VARIABLE") {
            report.warning(card.at, card.keyword.name, "the request names no variables", "list them on a data line");
        } else {
            found = subject.preselected();
        }
    }
    found
}
