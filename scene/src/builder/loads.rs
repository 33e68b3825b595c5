//! What acts along parts.

use super::{Builder, Numbered};
use ropewalk_core::{At, BuildError, Law, Part, Stations};

impl Builder {
    /// Makes a law act on the stations of parts; all parts that have stations if none is named.
    pub fn load<L: Law + Clone>(&mut self, on: &[String], law: L) -> Result<(), BuildError> {
        self.load_by(on, |_| law.clone())
    }

    /// The same with a law for each part.
    pub fn load_by<L: Law>(
        &mut self,
        on: &[String],
        law_of: impl Fn(&dyn Part) -> L,
    ) -> Result<(), BuildError> {
        let mut any = false;
        for (k, part) in self.parts(on)? {
            if let Some(stations) = part.stations().filter(|s| !s.is_empty()) {
                let law = law_of(part.as_ref());
                if law.gives().couple && !stations.couples() {
                    let message = format!(
                        "{} has a force conjugate to the slope, which `{}` can't carry",
                        law.label(),
                        part.name()
                    );
                    return Err(BuildError::at("on", message));
                }
                if L::NEEDS_DIAMETER && self.least_diameter(stations.as_ref()) == 0.0 {
                    let message = format!(
                        "{} needs a diameter, and `{}` has none: give its section a `diameter`, or name in `on` what \
                         it is to act on",
                        law.label(),
                        part.name()
                    );
                    return Err(BuildError::at("on", message));
                }
                let material = law.follows_material() && (0..2).any(|end| part.boundary(end).is_some());
                self.laws.entry((k, material)).or_default().push(law);
                any = true;
            } else if !on.is_empty() {
                return Err(BuildError::at("on", format!("`{}` carries no distributed load", part.name())));
            }
        }
        if any {
            Ok(())
        } else {
            Err(BuildError::new(
                "cables, chains and hulls carry this load, and the scene has none of them. Leave it out; a point mass has \
                 `drag_area`, `added_mass` and `volume` of its own",
            ))
        }
    }

    fn least_diameter(&self, stations: &dyn Stations) -> f64 {
        let (q, v) = (&self.start.q, &self.start.v);
        let at = At { t: 0.0, q, v, a: v, internal: &[], relaxed: None };
        let mut least = f64::INFINITY;
        stations.each(&at, &mut |s| least = least.min(s.diameter));
        least
    }

    pub(crate) fn weigh(&mut self, on: &[String]) {
        self.weighs.push(on.to_vec());
    }

    /// Whether a force gives a part its weight.
    pub fn weighs(&self, part: &str) -> bool {
        self.weighs.iter().any(|on| on.is_empty() || on.iter().any(|name| name == part))
    }

    /// Notes that a force of this type acts on a part.
    ///
    /// # Errors
    /// Another one does already: their effects would add up.
    pub fn acts_once(&mut self, kind: &'static str, part: &Numbered) -> Result<(), BuildError> {
        if self.acting.insert((kind, part.0)) {
            return Ok(());
        }
        let message = format!(
            "`{kind}` acts on `{}` twice, and would count twice: name in `on` what each of them is for",
            part.1.name()
        );
        Err(BuildError::at("on", message))
    }
}
