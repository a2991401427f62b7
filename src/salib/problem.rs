//! SALib's description of a problem: its inputs, and optionally their groups.

use serde::Deserialize;

use super::SalibError;

/// The subjects of the indices: every input by itself, or every group of inputs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SalibProblem {
    /// The inputs, in the order of the columns.
    pub inputs: Vec<String>,
    /// The subject of each index, in order: its name, and the indices of its inputs.
    pub members: Vec<(String, Vec<usize>)>,
}

impl SalibProblem {
    /// Creates a problem with an index for every input by itself.
    ///
    /// # Errors
    /// [`SalibError`] if there are no inputs, or two of one name.
    pub fn of_inputs(inputs: Vec<String>) -> Result<Self, SalibError> {
        if inputs.is_empty() {
            return Err(SalibError::Invalid("there are no inputs".to_owned()));
        }
        if let Some(k) = (1..inputs.len()).find(|&k| inputs[..k].contains(&inputs[k])) {
            return Err(SalibError::Invalid(format!("two inputs are called `{}`", inputs[k])));
        }
        let members = inputs.iter().enumerate().map(|(place, name)| (name.clone(), vec![place])).collect();
        Ok(Self { inputs, members })
    }

    /// Reads SALib's dictionary as JSON: `num_vars`, `names` and `groups` are read, bounds and distributions are not
    /// needed. Groups are counted in the order in which they first appear, as SALib does.
    ///
    /// ```
    /// use apportion::salib::SalibProblem;
    ///
    /// let text = r#"{"num_vars": 3, "names": ["a", "b", "c"], "groups": ["g", "h", "g"], "bounds": [[0, 1]]}"#;
    /// let problem = SalibProblem::parse(text)?;
    /// assert_eq!(problem.members[0], ("g".to_owned(), vec![0, 2]));
    /// # Ok::<(), apportion::salib::SalibError>(())
    /// ```
    ///
    /// # Errors
    /// [`SalibError`] if it is invalid.
    pub fn parse(text: &str) -> Result<Self, SalibError> {
        #[derive(Deserialize)]
        struct Typed {
            num_vars: Option<usize>,
            names: Vec<String>,
            groups: Option<Vec<String>>,
        }
        let example = r#"{"num_vars": 2, "names": ["x1", "x2"]}"#;
        let Typed { num_vars, names, groups } = serde_json::from_str(text).map_err(|error| {
            SalibError::Invalid(format!("not a problem of SALib in JSON, as in {example}: {error}"))
        })?;
        let stated = num_vars.unwrap_or(names.len());
        let problem = Self::of_inputs(names)?;
        for (key, list) in [("names", Some(&problem.inputs)), ("groups", groups.as_ref())] {
            if let Some(entries) = list.map(Vec::len).filter(|entries| *entries != stated) {
                let problem = format!("`num_vars` is {stated}, but `{key}` has {entries} entries");
                return Err(SalibError::Invalid(problem));
            }
        }
        let Some(groups) = groups else { return Ok(problem) };
        let mut members: Vec<(String, Vec<usize>)> = Vec::new();
        for (place, group) in groups.into_iter().enumerate() {
            match members.iter_mut().find(|(name, _)| *name == group) {
                Some((_, inputs)) => inputs.push(place),
                None => members.push((group, vec![place])),
            }
        }
        // SALib ignores a single group.
        if members.len() < 2 {
            return Ok(problem);
        }
        Ok(Self { members, ..problem })
    }
}
