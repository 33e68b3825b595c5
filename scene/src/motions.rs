//! The motions of a scene, some of which are made of others.

use crate::inputs::Inputs;
use crate::spec::MotionSpec;
use ropewalk_core::{BuildError, Motion};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Motions by their names.
pub(crate) type Motions = BTreeMap<String, Arc<dyn Motion>>;

/// What is said about a motion that isn't there.
pub(crate) fn no_motion<'a>(name: &str, there: impl Iterator<Item = &'a str>) -> String {
    let mut names: Vec<String> = there.map(|n| format!("`{n}`")).collect();
    names.sort();
    let names = if names.is_empty() { "none".into() } else { names.join(", ") };
    format!("there is no motion `{name}`; the motions are {names}")
}

/// Makes the motions of a scene, what is made of others after these; an error tells the number of its spec.
pub(crate) fn build_all(
    specs: &[Arc<dyn MotionSpec>],
    inputs: &Inputs,
    duration: f64,
) -> Result<Motions, (usize, BuildError)> {
    let mut number = BTreeMap::new();
    for (k, spec) in specs.iter().enumerate() {
        if number.insert(spec.name(), k).is_some() {
            let message = format!("there are two motions named `{}`", spec.name());
            return Err((k, BuildError::at("name", message)));
        }
    }
    let mut of: Vec<Vec<usize>> = Vec::with_capacity(specs.len());
    for (k, spec) in specs.iter().enumerate() {
        let find = |name: &String| {
            let there = specs.iter().map(|s| s.name());
            let missing = || (k, BuildError::at("motions", no_motion(name, there)));
            number.get(name.as_str()).copied().ok_or_else(missing)
        };
        of.push(spec.of().iter().map(find).collect::<Result<_, _>>()?);
    }
    let mut made: Vec<Option<Arc<dyn Motion>>> = vec![None; specs.len()];
    loop {
        let mut more = false;
        for (k, spec) in specs.iter().enumerate().filter(|(k, _)| made[*k].is_none()).collect::<Vec<_>>() {
            let parts: Option<Vec<_>> = of[k].iter().map(|j| made[*j].clone()).collect();
            let Some(parts) = parts else { continue };
            made[k] = Some(spec.build_for(&parts, inputs, duration).map_err(|e| (k, e))?);
            more = true;
        }
        let Some(stuck) = made.iter().position(Option::is_none) else { break };
        if !more {
            return Err(circle(specs, &of, &made, stuck));
        }
    }
    let names = specs.iter().map(|s| s.name().to_string());
    Ok(names.zip(made.into_iter().flatten()).collect())
}

/// The motions that are made of each other, from one that can't be made on.
fn circle(
    specs: &[Arc<dyn MotionSpec>],
    of: &[Vec<usize>],
    made: &[Option<Arc<dyn Motion>>],
    stuck: usize,
) -> (usize, BuildError) {
    let mut way = vec![stuck];
    loop {
        let here = way[way.len() - 1];
        let next = of[here].iter().copied().find(|k| made[*k].is_none()).unwrap_or(stuck);
        if let Some(first) = way.iter().position(|k| *k == next) {
            let names = way[first..].iter().chain([&next]).map(|k| format!("`{}`", specs[*k].name()));
            let message = format!(
                "the motions {} are made of each other: take one of them out",
                names.collect::<Vec<_>>().join(" of ")
            );
            return (next, BuildError::at("motions", message));
        }
        way.push(next);
    }
}
