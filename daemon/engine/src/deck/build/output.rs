//! Output requests. They hold from step to step until a step asks anew for the same kind.

mod variables;

use crate::model::{
    ContactRequest, Dialect, ElementRequest, NodeRequest, OutputRequests, OutputTarget, RestartFrequency,
    RestartRequest, SetId, SurfaceId, Totals,
};

use super::super::card::Card;
use super::super::report::excerpt;
use super::Builder;
use super::layout::StepCards;
use variables::{Subject, variables};

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

/// A contact request without selection.
const ALL_PAIRS: ContactRequest = ContactRequest {
    target: OutputTarget::Field,
    variables: Vec::new(),
    frequency: 1,
    secondary: None,
    primary: None,
    nodes: None,
    totals: false,
    summary: true,
};

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
                (Family::File, _) => (OutputTarget::File, self.frequency(card)),
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
        let summary = card.parameters.word("SUMMARY") != "NO";
        match subject {
            Subject::Nodes => {
                let Ok(set) = self.optional_set(card, "NSET") else { return };
                let totals = match card.parameters.word("TOTALS").as_str() {
                    "ONLY" => Totals::Only,
                    "YES" => Totals::Yes,
                    "" if card.parameters.has("TOTALS") => Totals::Yes,
                    _ => Totals::No,
                };
                requests.nodes.push((family, NodeRequest { target, set, variables, frequency, totals, summary }));
            }
            Subject::Elements => {
                let Ok(set) = self.optional_set(card, "ELSET") else { return };
                requests.elements.push((family, ElementRequest { target, set, variables, frequency, summary }));
            }
            Subject::Contacts => {
                if let Some(request) =
                    self.contact_request(card, ContactRequest { target, variables, frequency, summary, ..ALL_PAIRS })
                {
                    requests.contacts.push((family, request));
                }
            }
        }
    }

    /// Adds the selection of a contact request; none when what it names does not exist, which is reported.
    fn contact_request(&mut self, card: &Card, request: ContactRequest) -> Option<ContactRequest> {
        let (secondary, primary) = if request.target == OutputTarget::Print || request.target == OutputTarget::File {
            (
                self.optional_surface(card, &["SLAVE", "SECONDARY"]).ok()?,
                self.optional_surface(card, &["MASTER", "MAIN"]).ok()?,
            )
        } else {
            (None, None)
        };
        let nodes = match request.target {
            OutputTarget::Print | OutputTarget::File => self.optional_set(card, "NSET").ok()?,
            OutputTarget::Field | OutputTarget::History => None,
        };
        let totals = card.parameters.has("TOTALS") && card.parameters.word("TOTALS") != "NO";
        let request = ContactRequest { secondary, primary, nodes, totals, ..request };
        if (secondary.is_some() || primary.is_some()) && !self.model.pairs.iter().any(|pair| request.selects(pair)) {
            let message = "no contact pair has these surfaces";
            let remedy = "SLAVE and MASTER name the surfaces as the data line of *CONTACT PAIR does; leave them out for all pairs";
            self.report.error(card.at, card.keyword.name, message, remedy);
            return None;
        }
        Some(request)
    }

    /// Surface of a request, by one of the names that its parameter has: `Err` when it names one that does not exist, which is reported.
    fn optional_surface(&mut self, card: &Card, parameters: &[&str]) -> Result<Option<SurfaceId>, ()> {
        match parameters.iter().find_map(|parameter| card.parameters.value(parameter)) {
            None => Ok(None),
            Some(name) => {
                let surface = self.surfaces.refer(name, card.at, card.keyword.name, self.report);
                surface.map(|surface| Some(SurfaceId(surface))).ok_or(())
            }
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
                summary: true,
            };
            let element = ElementRequest {
                target,
                set: None,
                variables: Subject::Elements.preselected(),
                frequency,
                summary: true,
            };
            let contact = ContactRequest { target, variables: Subject::Contacts.preselected(), frequency, ..ALL_PAIRS };
            requests.nodes.push((family, node));
            requests.elements.push((family, element));
            requests.contacts.push((family, contact));
        }
        Database { target, frequency }
    }
}
