//! Output requests. They hold from step to step until a step asks anew for the same kind.

mod frequency;
mod variables;

use crate::model::{
    ContactRequest, Dialect, ElementRequest, NodeRequest, OutputFrequency, OutputRequests, OutputTarget, SetId,
    SurfaceId, Totals,
};

use super::super::card::Card;
use super::Builder;
use super::layout::StepCards;
use frequency::{Snapshots, default_of};
use variables::{Procedure, Subject, variables};

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
    /// `*OUTPUT, HISTORY`.
    history: Vec<OutputFrequency>,
    snapshots: Option<Snapshots>,
    /// Procedure of the present step.
    procedure: Procedure,
}

/// A contact request without selection.
const ALL_PAIRS: ContactRequest = ContactRequest {
    target: OutputTarget::Field,
    variables: Vec::new(),
    frequency: OutputFrequency::EVERY,
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
    frequency: OutputFrequency,
}

impl Requests {
    /// All requests in force.
    pub fn all(&self, dialect: Dialect) -> OutputRequests {
        OutputRequests {
            nodes: self.nodes.iter().map(|(_, request)| request.clone()).collect(),
            elements: self.elements.iter().map(|(_, request)| request.clone()).collect(),
            contacts: self.contacts.iter().map(|(_, request)| request.clone()).collect(),
            history: self.history.clone(),
            restart: self
                .snapshots
                .and_then(|snapshots| snapshots.in_step(dialect, self.procedure == Procedure::Explicit)),
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

impl Procedure {
    fn of(step: &StepCards<'_>) -> Self {
        let is_dynamic = step.cards.iter().any(|card| card.keyword.name == "*DYNAMIC");
        match (step.is_explicit(), is_dynamic) {
            (true, _) => Self::Explicit,
            (false, true) => Self::Implicit,
            (false, false) => Self::Static,
        }
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
        requests.snapshots = self.snapshots(card);
    }

    /// Takes the requests of a step into those in force.
    pub(super) fn output_requests(&mut self, step: &StepCards<'_>, requests: &mut Requests) {
        for card in step.cards.iter().filter(|card| card.keyword.name == "*RESTART") {
            self.restart_request(card, requests);
        }
        if let Some(snapshots) = &mut requests.snapshots {
            snapshots.enter_step();
        }
        requests.procedure = Procedure::of(step);
        let explicit = requests.procedure == Procedure::Explicit;
        let mut file = default_of(OutputTarget::File, explicit);
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
                        requests.history.clear();
                    }
                    database_begun = true;
                    database = Some(self.database(card, requests));
                    continue;
                }
                "*FILE OUTPUT" => {
                    // Abaqus/Explicit writes its results file at the end of the step unless told otherwise.
                    file = self.stated_frequency(card).unwrap_or(OutputFrequency::Intervals(1));
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
                (Family::Print, _) => {
                    let default = default_of(OutputTarget::Print, explicit);
                    (OutputTarget::Print, self.stated_frequency(card).unwrap_or(default))
                }
                (Family::File, _) => (OutputTarget::File, self.stated_frequency(card).unwrap_or(file)),
                (Family::Database, Some(database)) => (database.target, database.frequency),
                (Family::Database, None) => {
                    self.report.warning(
                        card.at,
                        card.keyword.name,
                        "there is no *OUTPUT above it: read as field output",
                        "write *OUTPUT, FIELD above it",
                    );
                    (OutputTarget::Field, default_of(OutputTarget::Field, explicit))
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
        frequency: OutputFrequency,
        requests: &mut Requests,
    ) {
        let variables = variables(card, subject, requests.procedure, self.report);
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

    fn database(&mut self, card: &Card, requests: &mut Requests) -> Database {
        let target = match (card.parameters.has("FIELD"), card.parameters.has("HISTORY")) {
            (false, true) => OutputTarget::History,
            (true, true) => {
                self.report.error(card.at, "*OUTPUT", "FIELD and HISTORY exclude each other", "write two *OUTPUT");
                OutputTarget::Field
            }
            _ => OutputTarget::Field,
        };
        let procedure = requests.procedure;
        let default = default_of(target, procedure == Procedure::Explicit);
        let frequency = self.stated_frequency(card).unwrap_or(default);
        if target == OutputTarget::History {
            requests.history.push(frequency);
        }
        if card.parameters.has("VARIABLE") && target == OutputTarget::Field {
            let (family, target) = (Family::Database, OutputTarget::Field);
            let node = NodeRequest {
                target,
                set: None,
                variables: Subject::Nodes.preselected(procedure),
                frequency,
                totals: Totals::No,
                summary: true,
            };
            let element = ElementRequest {
                target,
                set: None,
                variables: Subject::Elements.preselected(procedure),
                frequency,
                summary: true,
            };
            let contact =
                ContactRequest { target, variables: Subject::Contacts.preselected(procedure), frequency, ..ALL_PAIRS };
            requests.nodes.push((family, node));
            requests.elements.push((family, element));
            requests.contacts.push((family, contact));
        }
        Database { target, frequency }
    }
}
