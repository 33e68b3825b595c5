//! The peers: their packages in an environment of their own under `target/`, one process for each run.

use crate::job::Answer;
use serde_json::Value;
use std::collections::BTreeMap;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Runs the scripts of this folder.
pub struct Peers {
    python: Option<PathBuf>,
    /// Packages that are there, with their versions.
    pub versions: Vec<(String, String)>,
}

impl Peers {
    /// Without any peer.
    pub fn none() -> Self {
        Peers { python: None, versions: Vec::new() }
    }

    /// Installs what is missing. A package that can't be had is one line, and the rest goes on.
    pub fn install() -> Self {
        let folder = folder().join("venv");
        let python = folder.join("bin").join("python");
        if !python.exists() {
            println!("making an environment for the peers in {}", folder.display());
            let made = Command::new("python3").args(["-m", "venv"]).arg(&folder).output();
            if let Some(why) = failure(&made) {
                println!("no peers: `python3 -m venv` failed: {why}");
                return Peers::none();
            }
        }
        let mut versions = Vec::new();
        for package in include_str!("requirements.txt").lines() {
            let pip = ["-m", "pip", "install", "--quiet", "--disable-pip-version-check", package];
            match failure(&Command::new(&python).args(pip).output()) {
                Some(why) => println!("{package} can't be installed, and its runs are left out: {why}"),
                None => versions.extend(
                    package.split_once("==").map(|(name, version)| (name.to_string(), version.to_string())),
                ),
            }
        }
        Peers { python: Some(python), versions }
    }

    /// Whether a peer is there.
    pub fn has(&self, name: &str) -> bool {
        self.versions.iter().any(|(n, _)| n == name)
    }

    /// Name, as the peer writes it, and version.
    pub fn label(&self, name: &str) -> String {
        let own = match name {
            "exudyn" => "Exudyn",
            "moordyn" => "MoorDyn",
            "cabledyn" => "CableDyn",
            _ => name,
        };
        let version = self.versions.iter().find(|(n, _)| n == name).map_or("", |(_, v)| v);
        format!("{own} {version}")
    }

    /// The answer to a case whose result doesn't change: kept between runs, with the peer's version.
    pub fn run_once(&self, name: &str, script: &str, case: &Value) -> Result<Answer, String> {
        let path = folder().join("converged.json");
        let read = std::fs::read_to_string(&path).ok().and_then(|text| serde_json::from_str(&text).ok());
        let mut kept: BTreeMap<String, Answer> = read.unwrap_or_default();
        let key = format!("{} {case}", self.label(name));
        if let Some(answer) = kept.get(&key) {
            return Ok(answer.clone());
        }
        eprintln!("{script}, converged");
        let answer = self.run(script, case)?;
        kept.insert(key, answer.clone());
        let text = serde_json::to_string(&kept).map_err(|e| e.to_string())?;
        std::fs::write(&path, text).map_err(|e| format!("{}: {e}", path.display()))?;
        Ok(answer)
    }

    /// Runs a script on a case.
    pub fn run(&self, script: &str, case: &Value) -> Result<Answer, String> {
        let python = self.python.as_ref().ok_or("no peers")?;
        let mut child = Command::new(python)
            .arg(format!("{}/benches/peers/{script}", env!("CARGO_MANIFEST_DIR")))
            .envs(["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"].map(|name| (name, "1")))
            .env("PYTHONDONTWRITEBYTECODE", "1")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .map_err(|e| format!("{script}: {e}"))?;
        if let Some(mut input) = child.stdin.take() {
            input.write_all(case.to_string().as_bytes()).map_err(|e| format!("{script}: {e}"))?;
        }
        let output = child.wait_with_output();
        if let Some(why) = failure(&output) {
            return Err(format!("{script}: {why}"));
        }
        let text = output.map(|o| String::from_utf8_lossy(&o.stdout).into_owned()).unwrap_or_default();
        serde_json::from_str(&text).map_err(|e| format!("{script}: {e} in its answer {text:.60}"))
    }
}

/// Where what is only for this machine is kept.
pub fn folder() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).with_file_name("peers")
}

/// The last line that a failed command wrote, or how it ended; nothing if it did well.
fn failure(output: &std::io::Result<std::process::Output>) -> Option<String> {
    match output {
        Err(e) => Some(e.to_string()),
        Ok(o) if o.status.success() => None,
        Ok(o) => {
            let text = String::from_utf8_lossy(&o.stderr);
            let line = text.lines().rev().find(|l| !l.trim().is_empty());
            Some(line.map_or(o.status.to_string(), |l| l.trim().chars().take(300).collect()))
        }
    }
}
