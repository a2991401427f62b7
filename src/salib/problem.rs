//! SALib's description of a problem: its inputs, and perhaps their groups.

use serde::Deserialize;
use thiserror::Error;

/// What indices are asked of: every input by itself, or every group of inputs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SalibProblem {
    /// The inputs, in the order of the columns.
    pub inputs: Vec<String>,
    /// What each index is of, in order: its name, and the numbers of its inputs.
    pub members: Vec<(String, Vec<usize>)>,
}

/// What is wrong with a description of a problem.
#[derive(Debug, Error)]
pub enum ProblemError {
    /// No JSON of a problem.
    #[error("not a problem of SALib in JSON, as in {{\"num_vars\": 2, \"names\": [\"x1\", \"x2\"]}}: {0}")]
    NotOne(#[from] serde_json::Error),
    /// `num_vars` and the names disagree.
    #[error("`num_vars` is {stated}, but `{key}` has {found} entries")]
    Count {
        /// `num_vars`.
        stated: usize,
        /// `names` or `groups`.
        key: &'static str,
        /// Its entries.
        found: usize,
    },
    /// No inputs.
    #[error("there are no inputs")]
    NoInputs,
    /// A name twice.
    #[error("two inputs are called `{name}`")]
    Repeated {
        /// The name.
        name: String,
    },
}

impl SalibProblem {
    /// Indices of every input by itself.
    ///
    /// # Errors
    /// [`ProblemError`] if there are no inputs, or two of one name.
    pub fn of_inputs(inputs: Vec<String>) -> Result<Self, ProblemError> {
        if inputs.is_empty() {
            return Err(ProblemError::NoInputs);
        }
        if let Some(k) = (1..inputs.len()).find(|&k| inputs[..k].contains(&inputs[k])) {
            return Err(ProblemError::Repeated { name: inputs[k].clone() });
        }
        let members = inputs.iter().enumerate().map(|(place, name)| (name.clone(), vec![place])).collect();
        Ok(Self { inputs, members })
    }

    /// From SALib's dictionary as JSON: `num_vars`, `names` and `groups` are read, bounds and distributions are not
    /// needed. Groups are counted in the order in which they first appear, as SALib does.
    ///
    /// ```
    /// use apportion::salib::SalibProblem;
    ///
    /// let text = r#"{"num_vars": 3, "names": ["a", "b", "c"], "groups": ["g", "h", "g"], "bounds": [[0, 1]]}"#;
    /// let problem = SalibProblem::parse(text)?;
    /// assert_eq!(problem.members[0], ("g".to_owned(), vec![0, 2]));
    /// # Ok::<(), apportion::salib::ProblemError>(())
    /// ```
    ///
    /// # Errors
    /// [`ProblemError`] if it is none.
    pub fn parse(text: &str) -> Result<Self, ProblemError> {
        #[derive(Deserialize)]
        struct Typed {
            num_vars: Option<usize>,
            names: Vec<String>,
            groups: Option<Vec<String>>,
        }
        let Typed { num_vars, names, groups } = serde_json::from_str(text)?;
        let stated = num_vars.unwrap_or(names.len());
        let problem = Self::of_inputs(names)?;
        let counts = [("names", Some(problem.inputs.len())), ("groups", groups.as_ref().map(Vec::len))];
        if let Some((key, Some(found))) = counts.into_iter().find(|(_, found)| found.is_some_and(|n| n != stated)) {
            return Err(ProblemError::Count { stated, key, found });
        }
        let Some(groups) = groups else { return Ok(problem) };
        let mut members: Vec<(String, Vec<usize>)> = Vec::new();
        for (place, group) in groups.into_iter().enumerate() {
            match members.iter_mut().find(|(name, _)| *name == group) {
                Some((_, inputs)) => inputs.push(place),
                None => members.push((group, vec![place])),
            }
        }
        // One group in all is none, to SALib.
        if members.len() < 2 {
            return Ok(problem);
        }
        Ok(Self { members, ..problem })
    }
}
