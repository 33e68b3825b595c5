//! What the error of a run depends on, where tighter steps or a finer mesh change it far more than they should.
//!
//! A finer mesh is one of the runs of the certificate already. What tighter steps change may come of the steps, of what
//! Newton's method leaves in each of them, or of the motion, which makes more of every error than it was. Runs that are
//! solved to the end tell them apart: with the same steps, with the tighter ones, and with tighter ones again.

use super::FAR;
use super::compare::{all, change as of_record, moved};
use super::statement::{Cause, Certificate};
use crate::error::Error;
use crate::study::{Axes, Run, Runs, Settings, Target};
use ropewalk_report::Watch;

/// Tolerance of Newton's method, in parts of the scene's own, that solves to the end.
const SOLVED: f64 = 1e-3;
/// Of two changes one explains the other if it is more than this part of it.
const EXPLAINS: f64 = 0.5;

/// The largest change between two runs, of positions and of records.
fn change(records: &[Target], a: &Run, b: &Run) -> f64 {
    let positions = moved(a, b).unwrap_or(0.0);
    let records = records.iter().map(|target| of_record(target, a, b).unwrap_or(f64::INFINITY));
    // a NaN counts as the largest
    records.fold(positions, |m, x| if x <= m { m } else { x })
}

/// Looks for the cause of what a certificate found; none if nothing is far off, or if it was stopped.
///
/// # Errors
/// Threads that can't be had.
pub(super) fn find(
    runs: &Runs<'_>,
    settings: &Settings,
    records: &[Target],
    certificate: &Certificate,
    watch: Watch,
) -> Result<Option<Cause>, Error> {
    let far = FAR * certificate.tolerance;
    let largest = |all: &mut dyn Iterator<Item = f64>| all.fold(0.0, |m: f64, x| if x <= m { m } else { x });
    let by_mesh = largest(&mut certificate.records.iter().filter_map(|c| c.mesh));
    let by_steps =
        largest(&mut certificate.records.iter().filter_map(|c| c.step).chain(certificate.positions));
    if by_mesh > far && by_mesh >= by_steps {
        return Ok(Some(Cause::Mesh));
    }
    let (Some(stepping), true) = (settings.stepping, by_steps > far) else { return Ok(None) };
    let solved = Settings { newton: settings.newton.map(|n| SOLVED * n), ..*settings };
    let (tight, tighter) = (Axes::tighter(stepping), Axes::tighter(Axes::tighter(stepping)));
    let wanted = [
        *settings,
        solved,
        settings.stepped(Some(tight)),
        solved.stepped(Some(tight)),
        solved.stepped(Some(tighter)),
    ];
    let Some(runs) = all(runs, &wanted, watch)? else { return Ok(None) };
    let [own, solved, tight, solved_tight, solved_tighter] = &runs[..] else { return Ok(None) };
    let between = |a: &Run, b: &Run| change(records, a, b);
    // tighter steps may leave more than the run's own
    let by_newton = largest(&mut [between(own, solved), between(tight, solved_tight)].into_iter());
    let first = between(solved, solved_tight);
    let second = between(solved_tight, solved_tighter);
    let all = between(own, tight);
    Ok(Some(match () {
        () if by_newton > EXPLAINS * all && first <= EXPLAINS * all => Cause::Newton,
        () if second <= EXPLAINS * first => Cause::Steps,
        () => Cause::Motion,
    }))
}
