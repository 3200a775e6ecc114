//! Which studies of a list are one task's.

use std::str::FromStr;

use anyhow::{Context, Result, bail, ensure};
use sha2::{Digest, Sha256};

/// One of `count` parts of a list; parts are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Partition {
    rule: Rule,
    part: u64,
    count: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// Every `count`-th study of the list.
    Slice,
    /// By the study's name alone, so that a study stays in its part while the list grows.
    Hash,
}

impl Partition {
    /// All of a list.
    pub(super) const WHOLE: Self = Self {
        rule: Rule::Slice,
        part: 1,
        count: 1,
    };

    /// The part of a task of a Slurm array, where the environment tells of one. `variable` looks a variable up.
    ///
    /// # Errors
    /// For numbers that are none, and for an array that is not counted in equal steps.
    pub(super) fn of_slurm(variable: impl Fn(&str) -> Option<String>) -> Result<Option<Self>> {
        let number = |name: &str| -> Result<Option<u64>> {
            let value = variable(name);
            let parse = |value: String| value.parse().with_context(|| format!("{name} is {value}"));
            value.map(parse).transpose()
        };
        let (Some(task), Some(count)) = (
            number("SLURM_ARRAY_TASK_ID")?,
            number("SLURM_ARRAY_TASK_COUNT")?,
        ) else {
            return Ok(None);
        };
        let first = number("SLURM_ARRAY_TASK_MIN")?.unwrap_or(0);
        let step = number("SLURM_ARRAY_TASK_STEP")?.unwrap_or(1).max(1);
        let place = task.checked_sub(first).filter(|place| place % step == 0);
        let part = place.map(|place| place / step).filter(|part| *part < count);
        let part = part.with_context(|| {
            format!("task {task} is none of {count} from {first} in steps of {step}: say which part it is with --partition")
        })?;
        Ok(Some(Self {
            rule: Rule::Slice,
            part: part + 1,
            count,
        }))
    }

    /// Whether a study, by its place in the list (from 0) and its name, is in this part.
    #[must_use]
    pub(super) fn holds(&self, place: usize, name: &str) -> bool {
        let number = match self.rule {
            Rule::Slice => place as u64,
            Rule::Hash => {
                let digest: [u8; 32] = Sha256::digest(name).into();
                digest
                    .first_chunk()
                    .map_or(0, |first| u64::from_be_bytes(*first))
            }
        };
        number % self.count == self.part - 1
    }
}

impl FromStr for Partition {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let what = || format!("'{text}' is not slice:M/N or hash:M/N");
        let (rule, numbers) = text.split_once(':').with_context(what)?;
        let (part, count) = numbers.split_once('/').with_context(what)?;
        let (part, count) = (
            part.parse().with_context(what)?,
            count.parse().with_context(what)?,
        );
        ensure!((1..=count).contains(&part), "'{text}': M is 1 to N");
        let rule = match rule {
            "slice" => Rule::Slice,
            "hash" => Rule::Hash,
            _ => bail!(what()),
        };
        Ok(Self { rule, part, count })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_study_is_in_one_part() {
        for rule in ["slice", "hash"] {
            for count in [1, 3, 7] {
                let parts: Vec<Partition> = (1..=count)
                    .map(|part| format!("{rule}:{part}/{count}").parse().unwrap())
                    .collect();
                for place in 0..50 {
                    let name = format!("study {place}");
                    let holding = parts.iter().filter(|part| part.holds(place, &name));
                    assert_eq!(holding.count(), 1, "{rule} {count} {place}");
                }
            }
        }
        let by_name: Partition = "hash:2/3".parse().unwrap();
        assert_eq!(by_name.holds(0, "a"), by_name.holds(9, "a"));
        for wrong in [
            "slice:0/3",
            "slice:4/3",
            "slice:1",
            "part:1/2",
            "hash:1/0",
            "hash:x/2",
        ] {
            assert!(wrong.parse::<Partition>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn a_task_of_an_array_has_its_part_however_it_is_counted() {
        let slurm = |id: &str, min: &str, step: &str| {
            let (id, min, step) = (id.to_owned(), min.to_owned(), step.to_owned());
            Partition::of_slurm(move |name| match name {
                "SLURM_ARRAY_TASK_ID" => Some(id.clone()),
                "SLURM_ARRAY_TASK_COUNT" => Some("4".to_owned()),
                "SLURM_ARRAY_TASK_MIN" => Some(min.clone()),
                "SLURM_ARRAY_TASK_STEP" => Some(step.clone()),
                _ => None,
            })
        };
        for (id, min, step) in [("2", "0", "1"), ("3", "1", "1"), ("15", "5", "5")] {
            assert_eq!(
                slurm(id, min, step).unwrap(),
                Some("slice:3/4".parse().unwrap())
            );
        }
        // An array of tasks 3, 7, 8 and 20 says nothing of which part each is.
        assert!(slurm("20", "3", "1").is_err());
        assert_eq!(Partition::of_slurm(|_| None).unwrap(), None);
    }
}
