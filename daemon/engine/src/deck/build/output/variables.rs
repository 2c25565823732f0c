//! Variable identifiers of output requests: what is written for each, and what becomes of the others.
//!
//! Three answers other than writing: an identifier of the manual whose values this analysis has, and does not write, gives a
//! warning; one that the procedure does not offer is refused, as in the manual; one that nobody knows is refused as a misspelling.

use super::super::super::card::Card;
use super::super::super::lex::{fields, key};
use super::super::super::report::{Report, excerpt};

/// What is asked for, by the second word of the keyword.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Subject {
    Nodes,
    Elements,
    Contacts,
}

/// The procedure of the step that a request stands in: what it offers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Procedure {
    #[default]
    Static,
    Implicit,
    Explicit,
}

/// What becomes of an identifier.
enum Meaning {
    /// These variables are written.
    Written(Vec<&'static str>),
    /// It is known and not written.
    NotWritten,
    /// The procedure does not offer it: whose it is, and what to do.
    NotOffered(&'static str, &'static str),
    Unknown,
}

/// An identifier of a contact request and what is written for it.
type Written = (&'static str, &'static [&'static str]);

const TRACTIONS: &[&str] = &["CPRESS", "CSHEAR1", "CSHEAR2"];
const VISCOUS: &[&str] = &["CDPRESS", "CDSHEAR1", "CDSHEAR2"];
const MOTIONS: &[&str] = &["COPEN", "CSLIP1", "CSLIP2"];

/// Identifiers of contact requests. Components of a total stand for its family: tables have all components.
const CONTACT: &[Written] = &[
    ("CSTRESS", TRACTIONS),
    ("CSTR", TRACTIONS),
    ("CPRESS", &["CPRESS"]),
    ("CSHEAR1", &["CSHEAR1"]),
    ("CSHEAR2", &["CSHEAR2"]),
    ("CDSTRESS", VISCOUS),
    ("CDPRESS", &["CDPRESS"]),
    ("CDSHEAR1", &["CDSHEAR1"]),
    ("CDSHEAR2", &["CDSHEAR2"]),
    ("CDISP", MOTIONS),
    ("CDIS", MOTIONS),
    ("COPEN", &["COPEN"]),
    ("CSLIP1", &["CSLIP1"]),
    ("CSLIP2", &["CSLIP2"]),
    ("CSTATUS", &["CSTATUS"]),
    ("CFN", &["CFN"]),
    ("CFS", &["CFS"]),
    ("CFT", &["CFT"]),
    ("CF", &["CFT"]),
    ("CMN", &["CMN"]),
    ("CMS", &["CMS"]),
    ("CMT", &["CMT"]),
    ("XN", &["XN"]),
    ("XS", &["XS"]),
    ("XT", &["XT"]),
    ("CAREA", &["CAREA"]),
];

/// Contact variables that exist and are not written.
const CONTACT_OTHERS: &[&str] = &[
    "CNORMF",
    "CSHEARF",
    "CFORCE",
    "CNAREA",
    "CTANDIR",
    "CTANDIR1",
    "CTANDIR2",
    "CSLIPEQ",
    "CSLIPR",
    "CLINELOAD",
    "CPOINTLOAD",
    "CELS",
    "CNUM",
    "PCON",
    "CTHICK",
];

/// Contact variables that Abaqus/Explicit alone offers; they are not written.
const OF_EXPLICIT: &[&str] = &["FSLIP", "FSLIPR", "FSLIPEQ", "FSLIP1", "FSLIP2", "FSLIPR1", "FSLIPR2"];

const THREE_DIMENSIONAL: &str = "CMN, CMS and CMT give the moments about the origin";
const LEAVE_OUT: &str = "leave it out: steps of elastic bodies have no such result";

/// Contact variables that steps of elastic bodies do not offer: identifiers, whose they are, what to do.
const NOT_OFFERED: &[(&[&str], &str, &str)] = &[
    (&["CTRQ", "CPPRESSTRQ"], "axisymmetric models offer it, and this one is three-dimensional", THREE_DIMENSIONAL),
    (
        &["HFL", "HFLA", "HTL", "HTLA", "SFDR", "SFDRA", "SFDRT", "SFDRTA", "WEIGHT"],
        "heat transfer and coupled temperature-displacement steps offer it",
        LEAVE_OUT,
    ),
    (
        &["SJD", "SJDA", "SJDT", "SJDTA", "ECD", "ECDA", "ECDT", "ECDTA"],
        "steps with electric currents offer it",
        LEAVE_OUT,
    ),
    (&["PFL", "PFLA", "PTL", "PTLA", "TPFL", "TPTL"], "steps with pore fluid offer it", LEAVE_OUT),
    (
        &["DBT", "DBSF", "DBS", "DBSTRESS", "BDSTAT", "CRSTS", "ENRRT", "EFENRRTR", "OPENBC"],
        "steps in which bonded surfaces part (*DEBOND) offer it",
        LEAVE_OUT,
    ),
    (&["CSDMG", "CSMAXSCRT", "CSMAXUCRT", "CSQUADSCRT", "CSQUADUCRT"], "cohesive contact offers it", LEAVE_OUT),
    (&["PPRESS"], "steps with *PRESSURE PENETRATION offer it", LEAVE_OUT),
    (&["SDV"], "user-defined interactions offer it", LEAVE_OUT),
    (OF_EXPLICIT, "Abaqus/Explicit offers it", "CSLIP1 and CSLIP2 (CDISP) are the slip in Abaqus/Standard"),
    (&["BONDSTAT", "BONDLOAD"], "Abaqus/Explicit offers it", LEAVE_OUT),
];

const NODE: &[Written] = &[
    ("U", &["U"]),
    ("UT", &["U"]),
    ("UR", &["UR"]),
    ("V", &["V"]),
    ("VT", &["V"]),
    ("VR", &["VR"]),
    ("A", &["A"]),
    ("AT", &["A"]),
    ("AR", &["AR"]),
    ("RF", &["RF"]),
    ("RT", &["RF"]),
    ("RM", &["RM"]),
];

/// Nodal variables that only dynamic steps have.
const OF_MOTION: &[&str] = &["V", "VR", "A", "AR"];

/// Nodal variables of Abaqus and CalculiX that exist and are not written.
const NODE_OTHERS: &[&str] = &[
    "CF", "CM", "COORD", "COOR", "TF", "VF", "PU", "PUR", "PHPOT", "NT", "RFL", "RFLE", "CFL", "EPOT", "POR", "PPOR",
    "TU", "TV", "TA", "GU", "GV", "GA", "MOT", "RVF", "RVT", "CECHG", "RCHG", "CECUR", "RECUR", "PABS", "PCAV", "CVOL",
    "PRF", "WARP", "NNC", "FILMCOEF", "SINKTEMP", "RBANG", "RBROT", "PN", "PNT", "PT", "PS", "PSF", "TT", "TS", "TTF",
    "TSF", "MF", "CP", "DEPT", "DEPF", "KEQ", "MAXU", "MACH", "POT", "SEN", "SF", "TURB", "VTF", "RFN", "BM", "STH",
    "CT",
];

const ELEMENT: &[Written] = &[("S", &["S"]), ("MISES", &["S"]), ("E", &["E"])];

/// Element variables of Abaqus and CalculiX that exist and are not written.
const ELEMENT_OTHERS: &[&str] = &[
    "EE",
    "IE",
    "PE",
    "PEEQ",
    "PEMAG",
    "PEQC",
    "CE",
    "CEEQ",
    "CEQ",
    "CEP",
    "EP",
    "EEP",
    "IEP",
    "PEP",
    "SP",
    "LE",
    "LEP",
    "NE",
    "NEP",
    "ER",
    "ERP",
    "SINV",
    "TRESC",
    "PRESS",
    "INV3",
    "SE",
    "SF",
    "SM",
    "SK",
    "SS",
    "SSAVG",
    "ENER",
    "ELEN",
    "ELSE",
    "ELKE",
    "ELPD",
    "ELCD",
    "ELVD",
    "ELASE",
    "ELDMD",
    "SENER",
    "PENER",
    "CENER",
    "VENER",
    "DMENER",
    "ESEDEN",
    "EVOL",
    "IVOL",
    "VOL",
    "ELVOL",
    "COORD",
    "COOR",
    "COORDS",
    "TEMP",
    "SDV",
    "FV",
    "HFL",
    "HFLM",
    "HFLF",
    "NFORC",
    "NFORCSO",
    "DG",
    "DGP",
    "STH",
    "STATUS",
    "LOADS",
    "FOUND",
    "FLUXS",
    "THE",
    "THEP",
    "MFR",
    "MFL",
    "POR",
    "SAT",
    "VOIDR",
    "SPE",
    "SEPE",
    "SEE",
    "SEP",
    "PS",
    "PHS",
    "PHE",
    "PHEPG",
    "EPG",
    "EFLX",
    "ECD",
    "ECURS",
    "NCURS",
    "NFLUX",
    "RBFOR",
    "RBANG",
    "RBROT",
    "CTF",
    "CEF",
    "CVF",
    "CRF",
    "CSF",
    "CU",
    "CCF",
    "CUF",
    "CP",
    "CV",
    "CA",
    "GRADV",
    "ALPHA",
    "YIELDS",
    "ESF1",
    "MASS",
    "MSS",
    "ERR",
    "HER",
    "ZZS",
    "ZZSR",
    "ME",
    "MAXE",
    "MAXS",
    "EMFB",
    "EMFE",
    "SVF",
    "SMID",
    "SNEG",
    "SPOS",
    "CENT",
    "EBHE",
    "EMAS",
    "RHO",
    "PSTAT",
    "SVAVG",
    "PEVAVG",
    "PEEQVAVG",
    "DAMAGEC",
    "DAMAGET",
    "SDEG",
    "SHRRATIO",
    "CDMG",
    "SDVINI",
    "STATUSXFEM",
    "PHILSM",
    "PSILSM",
    "FMIS",
    "TSHR",
    "CTSHR",
];

impl Subject {
    fn written(self) -> &'static [Written] {
        match self {
            Self::Nodes => NODE,
            Self::Elements => ELEMENT,
            Self::Contacts => CONTACT,
        }
    }

    fn others(self) -> &'static [&'static str] {
        match self {
            Self::Nodes => NODE_OTHERS,
            Self::Elements => ELEMENT_OTHERS,
            Self::Contacts => CONTACT_OTHERS,
        }
    }

    /// What a request without variables, PRESELECT and ALL mean.
    pub fn preselected(self, procedure: Procedure) -> Vec<String> {
        let names: &[&str] = match self {
            Self::Nodes if procedure != Procedure::Static => &["U", "V", "A", "RF"],
            Self::Nodes => &["U", "RF"],
            Self::Elements => &["S"],
            Self::Contacts => &["CPRESS", "CSHEAR1", "CSHEAR2", "COPEN", "CSLIP1", "CSLIP2"],
        };
        names.iter().map(|name| name.to_string()).collect()
    }

    fn meaning(self, word: &str, procedure: Procedure) -> Meaning {
        // U4 to U6 are rotations, V4 to V6 and A4 to A6 their rates, and RF4 to RF6 moments.
        match (self, word) {
            (Self::Nodes, "U4" | "U5" | "U6") => return Meaning::Written(vec!["UR"]),
            (Self::Nodes, "V4" | "V5" | "V6") => return Meaning::Written(vec!["VR"]),
            (Self::Nodes, "A4" | "A5" | "A6") => return Meaning::Written(vec!["AR"]),
            (Self::Nodes, "RF4" | "RF5" | "RF6") => return Meaning::Written(vec!["RM"]),
            _ => {}
        }
        let find = |name: &str| self.written().iter().find(|(known, _)| *known == name);
        let family = word.trim_end_matches(|c: char| c.is_ascii_digit());
        // CFNM, CMTM, …: the magnitude of a total.
        let magnitude = word.strip_suffix('M').filter(|family| family.len() == 3 && family.starts_with('C'));
        if let Some((_, names)) = find(word).or_else(|| find(family)).or_else(|| find(magnitude?)) {
            return Meaning::Written(names.to_vec());
        }
        if self == Self::Contacts && procedure == Procedure::Explicit && OF_EXPLICIT.contains(&word) {
            return Meaning::NotWritten;
        }
        if self == Self::Contacts
            && let Some((_, whose, remedy)) =
                NOT_OFFERED.iter().find(|(names, ..)| names.contains(&word) || names.contains(&family))
        {
            return Meaning::NotOffered(whose, remedy);
        }
        match self.others().contains(&word) || self.others().contains(&family) {
            true => Meaning::NotWritten,
            false => Meaning::Unknown,
        }
    }
}

/// Variables of a request that are written; others are reported.
pub fn variables(card: &Card, subject: Subject, procedure: Procedure, report: &mut Report) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut named = false;
    for line in card.lines().iter() {
        for field in fields(line.text.as_bytes()).filter(|field| !field.is_empty()) {
            named = true;
            let word = key(&String::from_utf8_lossy(field));
            if matches!(word.as_str(), "PRESELECT" | "ALL") {
                found.extend(subject.preselected(procedure));
                continue;
            }
            let known = || subject.written().iter().map(|(name, _)| *name);
            match subject.meaning(&word, procedure) {
                Meaning::Written(names) if procedure == Procedure::Static && OF_MOTION.contains(&names[0]) => {
                    let message = format!("{} is not written: a static step has no such result", excerpt(field));
                    report.warning(line.at, card.keyword.name, message, "ask for it in a dynamic step");
                    // The request may hold on in a dynamic step.
                    found.extend(names.iter().map(|name| name.to_string()));
                }
                Meaning::Written(names) => found.extend(names.iter().map(|name| name.to_string())),
                Meaning::NotWritten => {
                    let remedy = format!("variables are {}", known().collect::<Vec<_>>().join(", "));
                    report.warning(line.at, card.keyword.name, format!("{} is not written", excerpt(field)), remedy);
                }
                Meaning::NotOffered(whose, remedy) => {
                    let message = format!("{} is not offered: {whose}", excerpt(field));
                    report.error(line.at, card.keyword.name, message, remedy);
                }
                Meaning::Unknown => {
                    let remedy = match report.suggest(&word, known().chain(subject.others().iter().copied())) {
                        Some(near) => format!("did you mean {near}?"),
                        None => format!("variables are {}", known().collect::<Vec<_>>().join(", ")),
                    };
                    let message = format!("there is no output variable {}", excerpt(field));
                    report.error(line.at, card.keyword.name, message, remedy);
                }
            }
        }
    }
    if !named {
        if subject != Subject::Contacts && !card.parameters.has("VARIABLE") {
            report.warning(card.at, card.keyword.name, "the request names no variables", "list them on a data line");
        } else {
            found = subject.preselected(procedure);
        }
    }
    let mut once: Vec<String> = Vec::new();
    for name in found {
        if !once.contains(&name) {
            once.push(name);
        }
    }
    once
}

#[cfg(test)]
mod tests {
    use super::*;

    fn written(subject: Subject, word: &str) -> Vec<&'static str> {
        match subject.meaning(word, Procedure::Static) {
            Meaning::Written(names) => names,
            Meaning::NotWritten | Meaning::NotOffered(..) | Meaning::Unknown => Vec::new(),
        }
    }

    #[test]
    fn components_stand_for_what_they_belong_to() {
        for (word, expected) in [
            ("CSTRESS", &["CPRESS", "CSHEAR1", "CSHEAR2"][..]),
            ("CSHEAR2", &["CSHEAR2"]),
            ("CDIS", &["COPEN", "CSLIP1", "CSLIP2"]),
            ("CFN", &["CFN"]),
            ("CFN3", &["CFN"]),
            ("CFNM", &["CFN"]),
            ("CMTM", &["CMT"]),
            ("XN2", &["XN"]),
            ("CF", &["CFT"]),
        ] {
            assert_eq!(written(Subject::Contacts, word), expected, "{word}");
        }
        assert_eq!(written(Subject::Nodes, "U3"), ["U"]);
        assert_eq!(written(Subject::Nodes, "U5"), ["UR"]);
        assert_eq!(written(Subject::Nodes, "RM1"), ["RM"]);
        assert_eq!(written(Subject::Nodes, "V2"), ["V"]);
        assert_eq!(written(Subject::Nodes, "VT3"), ["V"]);
        assert_eq!(written(Subject::Nodes, "V6"), ["VR"]);
        assert_eq!(written(Subject::Nodes, "A1"), ["A"]);
        assert_eq!(written(Subject::Nodes, "AR2"), ["AR"]);
        assert_eq!(written(Subject::Elements, "S12"), ["S"]);
    }

    #[test]
    fn every_identifier_has_one_meaning() {
        for subject in [Subject::Nodes, Subject::Elements, Subject::Contacts] {
            for name in subject.others() {
                assert!(matches!(subject.meaning(name, Procedure::Static), Meaning::NotWritten), "{name}");
            }
        }
        for name in NOT_OFFERED.iter().flat_map(|(names, ..)| *names) {
            assert!(matches!(Subject::Contacts.meaning(name, Procedure::Static), Meaning::NotOffered(..)), "{name}");
        }
        for name in OF_EXPLICIT {
            assert!(matches!(Subject::Contacts.meaning(name, Procedure::Explicit), Meaning::NotWritten), "{name}");
        }
        assert!(matches!(Subject::Contacts.meaning("CPRES", Procedure::Static), Meaning::Unknown));
        assert!(matches!(Subject::Nodes.meaning("CPRESS", Procedure::Implicit), Meaning::Unknown));
    }
}
