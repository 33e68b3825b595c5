//! All that water does to a station, at once.

use crate::wetted::add_share;
use crate::{AddedMass, AllRound, Buoyancy, Drag, FroudeKrylov, Immersed, InWaves, Surface, Wetted};
use ropewalk_core::{Gives, Joined, Law, Load, Real, Station};
use std::any::Any;
use std::sync::Arc;

/// The loads of several laws of the same water: its motion, and how much of a station is wet, are found once for all.
#[derive(Clone, Debug)]
pub(crate) struct InWater {
    surface: Surface,
    buoyancy: Option<Buoyancy>,
    drag: Option<Drag>,
    added_mass: Option<AddedMass>,
    all_round: Option<AllRound>,
    pressure: Option<FroudeKrylov>,
}

impl InWater {
    /// Two laws of the water below a surface together, if they are such.
    pub fn join(surface: &Surface, law: &dyn Any, other: &dyn Any) -> Option<Joined> {
        let none = InWater {
            surface: surface.clone(),
            buoyancy: None,
            drag: None,
            added_mass: None,
            all_round: None,
            pressure: None,
        };
        none.with(law)?.with(other).map(Joined::new)
    }

    /// The same with another law.
    fn with(mut self, law: &dyn Any) -> Option<Self> {
        match law.downcast_ref::<Buoyancy>() {
            Some(law) if law.surface == self.surface => put(&mut self.buoyancy, law)?,
            Some(_) => return None,
            None => {
                let InWater { surface, drag, added_mass, all_round, pressure, .. } = &mut self;
                below(surface, law, drag)
                    .or_else(|| below(surface, law, added_mass))
                    .or_else(|| below(surface, law, all_round))
                    .or_else(|| below(surface, law, pressure))?;
            }
        }
        Some(self)
    }

    /// What all of them have in `f`, from water that is everywhere.
    #[inline(always)]
    fn whole<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        mut waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        if let Some(drag) = &self.drag {
            drag.load_in::<R, TANGENT, D>(at, waves.as_deref_mut(), out);
        }
        if let Some(added_mass) = &self.added_mass {
            added_mass.load_in::<R, TANGENT, D>(at, waves.as_deref_mut(), out);
        }
        if let Some(all_round) = &self.all_round {
            all_round.load_in::<R, TANGENT, D>(at, waves.as_deref_mut(), out);
        }
        if let Some(pressure) = &self.pressure {
            pressure.load_in::<R, TANGENT, D>(at, waves.as_deref_mut(), out);
        }
        if TANGENT && let Some(waves) = waves {
            waves.put(out);
        }
    }

    /// The same with buoyancy, by the share of the station that is wet.
    #[inline(always)]
    fn load_in<R: Real, const TANGENT: bool, const D: usize>(
        &self,
        at: &Station<R>,
        waves: Option<&mut InWaves<R, D>>,
        out: &mut Load<R>,
    ) {
        let top = waves.as_ref().map(|waves| waves.swell.top);
        let top = top.as_ref();
        let wet = if self.surface.covers(at, top) {
            self.whole::<R, TANGENT, D>(at, waves, out);
            self.surface.wet_below(at, top)
        } else {
            let (wet, mut whole) = (self.surface.wet(at, top), Load::zero());
            self.whole::<R, TANGENT, D>(at, waves, &mut whole);
            add_share::<R, TANGENT>(&wet, top, &whole, out);
            wet
        };
        if let Some(buoyancy) = &self.buoyancy {
            buoyancy.lift::<R, TANGENT>(at, &wet, top, out);
        }
    }
}

/// Puts a law where none is yet.
fn put<L: Clone>(place: &mut Option<L>, law: &L) -> Option<()> {
    place.is_none().then(|| *place = Some(law.clone()))
}

/// The same, if it is one of the water below a surface, with its waves.
fn below<L: Immersed + Clone>(surface: &Surface, law: &dyn Any, place: &mut Option<L>) -> Option<()> {
    let Wetted { law, surface: own, above } = law.downcast_ref::<Wetted<L>>()?;
    let same = match (law.sea(), &surface.sea) {
        (Some(own), Some(sea)) => Arc::ptr_eq(own, sea),
        (own, sea) => own.is_none() && sea.is_none(),
    };
    if same && own == surface && !above { put(place, law) } else { None }
}

impl Law for InWater {
    fn label(&self) -> String {
        "water".into()
    }
    fn gives(&self) -> Gives {
        let all = [
            self.buoyancy.as_ref().map(Law::gives),
            self.drag.as_ref().map(Law::gives),
            self.added_mass.as_ref().map(Law::gives),
            self.all_round.as_ref().map(Law::gives),
            self.pressure.as_ref().map(Law::gives),
        ];
        let wetted = Gives { x: true, slope: true, ..Gives::NOTHING };
        all.into_iter().flatten().fold(wetted, Gives::and)
    }
    #[inline(always)]
    fn load<R: Real, const TANGENT: bool>(&self, t: f64, at: &Station<R>, out: &mut Load<R>) {
        // compiled apart, so that still water knows nothing of waves
        match &self.surface.sea {
            None => self.load_in::<R, TANGENT, 3>(at, None, out),
            Some(sea) => self.load_in::<R, TANGENT, 3>(at, Some(&mut InWaves::of(sea.along(t, at))), out),
        }
    }
    #[inline(always)]
    fn load_all<'a, R: Real, const TANGENT: bool>(
        &self,
        t: f64,
        stations: impl Iterator<Item = (Station<R>, &'a mut Load<R>)>,
    ) {
        // bodies of one station have moved on by the next
        match self.surface.sea.as_ref().filter(|_| R::LANES > 1).and_then(|sea| sea.table()) {
            None => {
                for (at, out) in stations {
                    self.load::<R, TANGENT>(t, &at, out);
                }
            }
            Some(mut table) => {
                for (at, out) in stations {
                    let mut waves = InWaves::of(table.along(t, &at));
                    self.load_in::<R, TANGENT, 2>(&at, Some(&mut waves), out);
                }
            }
        }
    }
    fn join(&self, other: &dyn Any) -> Option<Joined> {
        self.clone().with(other).map(Joined::new)
    }
}
