//! The combinations of a sweep.

use super::axis::{Axis, unquoted};
use super::manifest::{Samples, SceneCopy, SweepManifest, VariedCopy};
use ropewalk_models::Bundled;
use ropewalk_report::plain;
use ropewalk_scene::quantity::Written;
use ropewalk_scene::{Fault, Sampling, SceneFile, SceneText, Varied, quoted};
use std::collections::HashSet;

/// A name longer than this makes a poor folder.
const LONGEST_NAME: usize = 100;

/// All combinations of scenes and values; those that differ in the last parameter follow each other. Parameters that are
/// drawn from ranges change together, from run to run, and every combination of the others has all their samples.
pub struct Grid {
    scenes: Vec<SceneText>,
    set: Vec<String>,
    vary: Vec<Varied>,
    /// How those were drawn whose place in `sampled` says so.
    sampling: Option<Sampling>,
    sampled: Vec<bool>,
    names: Vec<String>,
}

impl Grid {
    /// Reads the scenes, `--set name=value` and `--vary name=value,value,…`, where with samples a value may be `from..to`.
    ///
    /// # Errors
    /// Something is wrong with them, as far as that can be told without building the scenes.
    pub fn new(
        scenes: &[String],
        set: &[String],
        vary: &[String],
        sampling: Option<Sampling>,
        bundled: &[Bundled],
    ) -> Result<Self, Fault> {
        let scenes: Vec<SceneText> =
            scenes.iter().map(|s| SceneText::open(s, bundled)).collect::<Result<_, _>>()?;
        let mut names = HashSet::new();
        if let Some(s) = scenes.iter().find(|s| !names.insert(s.name.as_str())) {
            return Err(Fault::new(format!("there are two scenes named {}", quoted(&s.name)))
                .with_help("their runs could not be told apart: copy one to another name"));
        }
        if let Some(samples) = sampling.filter(|s| s.count > Varied::MOST) {
            let message = format!("{} samples are more than {}", samples.count, Varied::MOST);
            return Err(Fault::new(message).with_help("split the sweep by seeds"));
        }
        let drawn = |text: &String| sampling.as_ref().map_or(Ok(None), |s| s.draw(text));
        let drawn: Vec<Option<Varied>> = vary.iter().map(drawn).collect::<Result<_, _>>()?;
        let sampled: Vec<bool> = drawn.iter().map(Option::is_some).collect();
        if sampling.is_some() && !sampled.contains(&true) {
            return Err(Fault::new("there is no range to draw samples from")
                .with_help("give one, as in `--vary 'speed=5..25 kn'`"));
        }
        let read = |(drawn, text): (Option<Varied>, &String)| drawn.map_or_else(|| Varied::parse(text), Ok);
        let vary: Vec<Varied> = drawn.into_iter().zip(vary).map(read).collect::<Result<_, _>>()?;
        if vary.is_empty() && scenes.len() < 2 {
            return Err(
                Fault::new("nothing is varied").with_help("vary a parameter, as in `--vary speed=5kn,15kn`")
            );
        }
        let mut names = HashSet::new();
        if let Some(v) = vary.iter().find(|v| !names.insert(v.name.as_str())) {
            return Err(Fault::new(format!("{} is varied twice", quoted(&v.name)))
                .with_help(format!("give all its values at once, as in `--vary {}=1,2,3`", v.name)));
        }
        let is_set =
            |v: &&Varied| set.iter().any(|s| s.split('=').next().map(str::trim) == Some(v.name.as_str()));
        if let Some(v) = vary.iter().find(is_set) {
            return Err(Fault::new(format!("{} is both set and varied", quoted(&v.name)))
                .with_help("leave away one of `--set` and `--vary`"));
        }
        let listed = vary.iter().zip(&sampled).filter(|(_, sampled)| !**sampled).map(|(v, _)| v.values.len());
        let runs = listed.chain(sampling.map(|s| s.count)).fold(scenes.len(), usize::saturating_mul);
        if runs > Varied::MOST {
            let text = if runs == usize::MAX { "too many".to_string() } else { runs.to_string() };
            return Err(Fault::new(format!("{text} combinations are more than {}", Varied::MOST))
                .with_help("vary fewer parameters at once, or split the sweep"));
        }
        let mut grid = Grid { scenes, set: set.to_vec(), vary, sampling, sampled, names: Vec::new() };
        grid.names = grid.unique_names(runs);
        Ok(grid)
    }

    /// Number of combinations.
    #[allow(clippy::len_without_is_empty)] // there is always one
    pub fn len(&self) -> usize {
        self.names.len()
    }
    /// Name of a combination and of its folder: `speed=5kn,start=40`.
    pub(super) fn name(&self, k: usize) -> &str {
        &self.names[k]
    }
    /// The scenes' names.
    pub(super) fn scenes(&self) -> Vec<&str> {
        self.scenes.iter().map(|s| s.name.as_str()).collect()
    }
    /// Which scene and which value of each parameter a combination has.
    pub(super) fn choice(&self, k: usize) -> (usize, Vec<usize>) {
        let samples = self.sampling.map_or(1, |s| s.count);
        let (mut rest, sample) = (k / samples, k % samples);
        let mut values: Vec<usize> = vec![sample; self.vary.len()];
        for ((value, v), _) in
            values.iter_mut().zip(&self.vary).zip(&self.sampled).rev().filter(|(_, s)| !**s)
        {
            *value = rest % v.values.len();
            rest /= v.values.len();
        }
        (rest, values)
    }
    /// The parameter that tables and pictures go by: the first that is drawn, or else the first.
    pub(super) fn main(&self) -> usize {
        self.sampled.iter().position(|sampled| *sampled).unwrap_or(0)
    }
    /// Whether points over that parameter have nothing to do with their neighbours.
    pub(super) fn is_scattered(&self) -> bool {
        self.sampled.iter().filter(|sampled| **sampled).count() > 1
    }
    /// The scene of a combination.
    ///
    /// # Errors
    /// The values don't go together.
    pub(super) fn file(&self, k: usize) -> Result<SceneFile, Fault> {
        let (scene, values) = self.choice(k);
        let overrides = self.vary.iter().zip(&values).map(|(v, i)| format!("{}={}", v.name, v.values[*i]));
        let all: Vec<String> = self.set.iter().cloned().chain(overrides).collect();
        self.scenes[scene].with(&all).map_err(|fault| self.at_option(fault, scene))
    }

    /// What the sweep is, to be known again.
    pub(super) fn manifest(&self) -> SweepManifest {
        let scene = |s: &SceneText| SceneCopy { name: s.name.clone(), text: s.text.clone() };
        let varied = |v: &Varied| VariedCopy { name: v.name.clone(), values: v.values.clone() };
        SweepManifest {
            ropewalk: env!("CARGO_PKG_VERSION").into(),
            runs: self.len(),
            set: self.set.clone(),
            vary: self.vary.iter().map(varied).collect(),
            samples: self.sampling.map(|s| Samples {
                count: s.count,
                seed: s.seed,
                latin: s.latin,
                of: self
                    .vary
                    .iter()
                    .zip(&self.sampled)
                    .filter(|(_, s)| **s)
                    .map(|(v, _)| v.name.clone())
                    .collect(),
            }),
            scenes: self.scenes.iter().map(scene).collect(),
        }
    }

    /// Builds every scene with every value once, the other parameters at their first values, before anything runs. Of
    /// values that are drawn these are the least and the largest.
    ///
    /// # Errors
    /// The first value that is wrong.
    pub(super) fn check(&self) -> Result<Vec<Axis>, Fault> {
        let mut defaults = vec![None; self.vary.len()];
        let samples = self.sampling.map_or(1, |s| s.count);
        for scene in 0..self.scenes.len() {
            let build = |k: usize| {
                let file = self.file(k)?;
                let model = file.build().map_err(|fault| self.at_option(fault, scene))?;
                file.records(&model).map_err(|fault| self.at_option(fault, scene))
            };
            let each = self.len() / self.scenes.len();
            build(scene * each)?;
            let mut stride = each;
            for (v, sampled) in self.vary.iter().zip(&self.sampled) {
                if *sampled {
                    extremes(v).into_iter().try_for_each(|i| build(scene * each + i).map(drop))?;
                } else {
                    stride /= v.values.len();
                    (1..v.values.len()).try_for_each(|i| build(scene * each + i * stride).map(drop))?;
                }
            }
            debug_assert_eq!(stride, samples);
            // a parameter may have no default, and then nothing is known about its unit
            if let Ok(file) = self.scenes[scene].with(&self.set) {
                for (default, v) in defaults.iter_mut().zip(&self.vary) {
                    let parameter = file.document().parameters().iter().find(|p| p.name == v.name);
                    *default = default.take().or_else(|| parameter.map(|p| p.value.clone()));
                }
            }
        }
        Ok(self.vary.iter().zip(&defaults).map(|(v, default)| Axis::new(v, default.as_ref())).collect())
    }

    /// A fault of a varied value was not written behind `--set`; and of several scenes it says which one.
    fn at_option(&self, mut fault: Fault, scene: usize) -> Fault {
        if let Some(place) = &mut fault.place
            && place.span.source() > self.set.len()
        {
            place.file = "--vary".into();
        }
        match self.scenes.len() {
            1 => fault,
            _ => fault.with_note(format!("in the scene {}", quoted(&self.scenes[scene].name))),
        }
    }

    /// The scene, if there are several, and the values of all parameters: `speed=5kn, start=40`.
    pub(super) fn label(&self, k: usize) -> String {
        self.words(k, |_| true)
    }

    /// The same without the parameter that tables and pictures go by, and without others that are drawn.
    pub(super) fn line(&self, k: usize) -> String {
        let main = self.main();
        self.words(k, |i| i != main && !self.sampled[i])
    }

    fn words(&self, k: usize, of: impl Fn(usize) -> bool) -> String {
        let (scene, values) = self.choice(k);
        let scene = (self.scenes.len() > 1).then(|| self.scenes[scene].name.clone());
        let value = |text: &str| unquoted(text).split_whitespace().collect::<String>();
        let pairs = self.vary.iter().zip(values).enumerate().filter(|(i, _)| of(*i));
        let pairs = pairs.map(|(_, (v, i))| format!("{}={}", v.name, value(&v.values[i])));
        scene.into_iter().chain(pairs).collect::<Vec<_>>().join(", ")
    }

    /// A name for each run that is a folder on every system: its values, or a number where that won't do.
    fn unique_names(&self, runs: usize) -> Vec<String> {
        let names: Vec<String> = (0..runs).map(|k| plain(&self.label(k).replace(", ", ","))).collect();
        // some systems take `L` and `l` for the same
        let different: HashSet<String> = names.iter().map(|n| n.to_lowercase()).collect();
        if different.len() == runs && names.iter().all(|n| n.len() <= LONGEST_NAME) {
            return names;
        }
        let digits = runs.to_string().len();
        (1..=runs).map(|k| format!("run-{k:0digits$}")).collect()
    }
}

/// Where the least and the largest value are.
fn extremes(varied: &Varied) -> [usize; 2] {
    let si = |i: &usize| Written::parse(&varied.values[*i]).map_or(f64::NAN, |w| w.si);
    let all = || 0..varied.values.len();
    let least = all().min_by(|a, b| si(a).total_cmp(&si(b))).unwrap_or(0);
    let largest = all().max_by(|a, b| si(a).total_cmp(&si(b))).unwrap_or(0);
    [least, largest]
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENES: &[Bundled] = &[
        Bundled { name: "a", text: "title = 'A'\n[parameters]\nx = 1\ny = '2 s'\nz = 'u'\n" },
        Bundled { name: "b", text: "title = 'B'\n[parameters]\nx = 1\ny = '2 s'\nz = 'u'\n" },
    ];

    fn grid(scenes: &[&str], set: &[&str], vary: &[&str]) -> Result<Grid, Fault> {
        let all = |list: &[&str]| list.iter().map(|s| (*s).to_string()).collect::<Vec<_>>();
        Grid::new(&all(scenes), &all(set), &all(vary), None, SCENES)
    }

    #[test]
    fn the_last_parameter_varies_fastest() {
        let g = grid(&["a", "b"], &[], &["x=1,2", "y=3 s,4 s,5 min"]).unwrap();
        assert_eq!(g.len(), 12);
        assert_eq!((g.name(0), g.name(1)), ("a,x=1,y=3s", "a,x=1,y=4s"));
        assert_eq!((g.name(3), g.name(11)), ("a,x=2,y=3s", "b,x=2,y=5min"));
        assert_eq!(g.choice(11), (1, vec![1, 2]));
        let g = grid(&["a", "b"], &[], &[]).unwrap();
        assert_eq!([g.name(0), g.name(1)], ["a", "b"]);
    }

    #[test]
    fn samples_change_together_beside_a_list() {
        let sampled = |vary: &[&str], count: usize| {
            let vary: Vec<String> = vary.iter().map(|v| (*v).to_string()).collect();
            let sampling = Some(Sampling { count, seed: 1, latin: true });
            Grid::new(&["a".into()], &[], &vary, sampling, SCENES)
        };
        let g = sampled(&["x=0..1", "z=u,v", "y=1..9 s"], 10).unwrap();
        assert_eq!((g.len(), g.main(), g.is_scattered()), (20, 0, true));
        assert_eq!((g.choice(3), g.choice(13)), ((0, vec![3, 0, 3]), (0, vec![3, 1, 3])));
        assert_eq!(g.line(3), "z=u");
        // one sample in each tenth, together with each value of the list
        let x: Vec<f64> = (0..10).map(|k| g.vary[0].values[k].parse::<f64>().unwrap()).collect();
        let mut tenths: Vec<usize> = x.iter().map(|x| (10.0 * x) as usize).collect();
        tenths.sort_unstable();
        assert_eq!(tenths, (0..10).collect::<Vec<_>>());
        let [least, largest] = extremes(&g.vary[0]);
        assert!(x.iter().all(|v| (x[least]..=x[largest]).contains(v)));
        let no_range = sampled(&["x=1,2"], 3).err().unwrap();
        assert!(no_range.message.contains("no range to draw samples from"), "{no_range}");
        let many = sampled(&["x=0..1", "y=1,2 s"], 100_000).err().unwrap();
        assert!(many.message.contains("200000 combinations"), "{many}");
        let unasked = grid(&["a"], &[], &["x=0..1"]).err().unwrap();
        assert!(unasked.help.is_some_and(|help| help.contains("--samples")));
    }

    #[test]
    fn names_are_folders_everywhere() {
        let g = grid(&["a"], &[], &["z=\"m/s\",a:b*"]).unwrap();
        assert_eq!([g.name(0), g.name(1)], ["z=m_s", "z=a_b_"]);
        for vary in ["z=l,L".to_string(), format!("z=1,{}", "long".repeat(30)), "z=a/b,a_b".into()] {
            let g = grid(&["a"], &[], &[&vary]).unwrap();
            assert_eq!([g.name(0), g.name(1)], ["run-1", "run-2"]);
        }
    }

    #[test]
    fn what_makes_no_sweep_is_refused() {
        for (scenes, set, vary, message) in [
            (&["a"][..], &[][..], &[][..], "nothing is varied"),
            (&["a", "a"], &[], &[], "two scenes named `a`"),
            (&["a"], &[], &["x=1", "x=2"], "`x` is varied twice"),
            (&["a"], &["x = 3"], &["x=1"], "`x` is both set and varied"),
            (&["a"], &[], &["x=1:1000:1", "y=1:1000:1"], "1000000 combinations"),
            (&["c"], &[], &["x=1"], "no bundled scene"),
        ] {
            let fault = grid(scenes, set, vary).err().unwrap();
            assert!(fault.message.contains(message) && fault.help.is_some(), "{fault}");
        }
    }
}
