//! Random scenes: whatever a text says, it ends in a typed error or in a finite state; never in a panic, a hang or a
//! number that isn't one.
//!
//! Everything is seeded: a find says its seed and the smallest scene that shows it. `FUZZ_TEXTS` and `FUZZ_ASSEMBLIES`
//! say how many the long, ignored run takes, `FUZZ_SEED` where it begins.

mod assembly;
mod finds;
mod guard;
mod nasty;
mod random;
mod text;

use guard::{Guard, Verdict};
use random::Rng;
use std::collections::BTreeMap;
use std::sync::Mutex;

/// Runs `count` cases from a seed on, each a text and what becomes of it; gives how often each verdict came.
fn hunt(
    what: &str,
    seeds: std::ops::Range<u64>,
    make: impl Fn(&mut Rng) -> String,
    judge: impl Fn(&str) -> Verdict,
) -> BTreeMap<&'static str, u64> {
    static ALONE: Mutex<()> = Mutex::new(());
    let _alone = ALONE.lock().unwrap_or_else(|broken| broken.into_inner());
    let (guard, mut seen) = (Guard::new(), BTreeMap::new());
    // what is caught is told below
    std::panic::set_hook(Box::new(|_| ()));
    for seed in seeds {
        let text = make(&mut Rng::new(seed));
        let verdict = guard.watch(what, seed, &text, || judge(&text));
        if let Verdict::Bad(why) = &verdict {
            let still = |t: &str| matches!(guard.watch(what, seed, t, || judge(t)), Verdict::Bad(_));
            let smallest = guard::smallest(&text, still);
            drop(std::panic::take_hook());
            panic!("{what} {seed}: {why}\n{smallest}");
        }
        *seen.entry(verdict.name()).or_default() += 1;
    }
    drop(std::panic::take_hook());
    println!("{what}: {seen:?}");
    seen
}

fn number(name: &str, default: u64) -> u64 {
    std::env::var(name).ok().map_or(default, |text| text.parse().expect(name))
}

fn texts(seeds: std::ops::Range<u64>) {
    let sources = text::sources();
    let seen = hunt("text", seeds, |rng| text::changed(rng, &sources), guard::read);
    // changes small enough that many of them still are scenes, and large enough that many aren't
    let all: u64 = seen.values().sum();
    assert!(seen["built"] > all / 20 && seen["refused"] > all / 3, "{seen:?}");
}

fn assemblies(seeds: std::ops::Range<u64>) {
    let seen = hunt("assembly", seeds, assembly::scene, guard::run);
    let all: u64 = seen.values().sum();
    assert!(seen["stepped"] >= all / 2, "less than half of them took their steps: {seen:?}");
}

#[test]
fn texts_end_in_an_error_or_a_scene() {
    texts(0..4000);
}

#[test]
fn assemblies_end_in_an_error_or_a_finite_state() {
    assemblies(0..400);
}

#[test]
fn finds_are_refused_now() {
    for find in finds::all() {
        let seen = hunt("find", 0..1, |_| find.clone(), guard::read);
        assert_eq!(seen.get("refused"), Some(&1), "{find}");
    }
}

#[test]
fn nasty_scenes_end_in_an_error_or_a_finite_state() {
    for text in nasty::all() {
        let seen = hunt("nasty", 0..1, |_| text.clone(), guard::run);
        println!("{seen:?}: {}", text.lines().last().unwrap_or_default());
    }
}

#[test]
#[ignore = "minutes; a million texts and ten thousand assemblies"]
fn many_texts_and_assemblies() {
    let seed = number("FUZZ_SEED", 1_000_000);
    texts(seed..seed + number("FUZZ_TEXTS", 1_000_000));
    assemblies(seed..seed + number("FUZZ_ASSEMBLIES", 10_000));
}
