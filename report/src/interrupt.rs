//! Ctrl-C and other signals: the first one asks a run to stop in good order, the second one ends the program.

use std::process;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};

use super::OutputError;

/// The signals that end a run, by number and name; shells tell of them by the exit code 128 + number.
const SIGNALS: [(u8, &str); 3] = [(SIGINT, "Ctrl-C"), (SIGTERM, "SIGTERM"), (SIGHUP, "SIGHUP")];
const SIGHUP: u8 = 1;
const SIGINT: u8 = 2;
const SIGTERM: u8 = 15;

static INSTALLED: AtomicBool = AtomicBool::new(false);
/// The first signal that came; 0 before.
static CAUSE: AtomicU8 = AtomicU8::new(0);

/// Says whether a run is to end: the user pressed Ctrl-C, or the system sent SIGTERM or SIGHUP.
///
/// The run polls [`requested`](Self::requested) after every step and stops with what it has
/// computed so far; a second signal doesn't wait for that. Signals are those of the process, so
/// all values of this type say the same.
#[derive(Debug, Clone, Copy)]
pub struct Interrupt(());

impl Interrupt {
    /// Begins to catch signals; calling it again changes nothing.
    ///
    /// Ctrl-C is caught even in a background job of a script, which shells start with Ctrl-C ignored:
    /// whoever sends SIGINT to a run wants it to stop. SIGHUP stays ignored where it is, as `nohup` has it.
    ///
    /// # Errors
    /// [`OutputError::Interrupt`] if the system refuses; the run can go on without.
    pub fn install() -> Result<Self, OutputError> {
        if INSTALLED.swap(true, Ordering::SeqCst) {
            return Ok(Self(()));
        }
        catch().map_err(|message| {
            INSTALLED.store(false, Ordering::SeqCst);
            OutputError::Interrupt { message }
        })?;
        Ok(Self(()))
    }

    /// Whether the run is to end. Costs as much as reading a variable.
    #[inline]
    pub fn requested(self) -> bool {
        CAUSE.load(Ordering::Relaxed) != 0
    }

    /// What asked for the end: `Ctrl-C`, `SIGTERM` or `SIGHUP`.
    pub fn cause() -> &'static str {
        let cause = CAUSE.load(Ordering::Relaxed);
        SIGNALS.iter().find(|(number, _)| *number == cause).map_or("Ctrl-C", |(_, name)| name)
    }

    /// The exit code of a program that was ended so, as shells expect it: 128 and the number of the signal.
    pub fn exit_code() -> u8 {
        128 + match CAUSE.load(Ordering::Relaxed) {
            0 => SIGINT,
            cause => cause,
        }
    }
}

/// Takes note of a signal; of the second one, the program takes no more notice than to end.
fn came(number: u8) {
    if CAUSE.compare_exchange(0, number, Ordering::SeqCst, Ordering::SeqCst).is_err() {
        process::exit(i32::from(Interrupt::exit_code()));
    }
}

#[cfg(unix)]
fn catch() -> Result<(), String> {
    let wanted = SIGNALS.iter().map(|(number, _)| *number).filter(|n| *n != SIGHUP || !hangup_is_ignored());
    let mut signals =
        signal_hook::iterator::Signals::new(wanted.map(i32::from)).map_err(|e| e.to_string())?;
    let listen = move || signals.forever().filter_map(|n| u8::try_from(n).ok()).for_each(came);
    std::thread::Builder::new().name("signals".into()).spawn(listen).map_err(|e| e.to_string())?;
    Ok(())
}

/// Whether the program was started with SIGHUP ignored, as by `nohup`. Where the system has no such file to tell it,
/// SIGHUP is left alone.
#[cfg(unix)]
fn hangup_is_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).is_none_or(|mask| mask & 1 != 0)
}

#[cfg(not(unix))]
fn catch() -> Result<(), String> {
    ctrlc::set_handler(|| came(SIGINT)).map_err(|e| e.to_string())
}

#[cfg(unix)]
#[cfg(test)]
mod tests {
    use super::*;
    use std::io::{BufRead, BufReader};
    use std::process::{Child, Command, Stdio};
    use std::time::{Duration, Instant};

    const ROLE: &str = "ROPEWALK_TEST_INTERRUPT_CHILD";

    /// Not a test of its own: what the other test runs as a process that it may interrupt.
    #[test]
    fn child_process() {
        let Ok(role) = std::env::var(ROLE) else {
            return;
        };
        let interrupt = Interrupt::install().unwrap();
        Interrupt::install().unwrap();
        println!("\nready");
        let start = Instant::now();
        while start.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(5));
            if interrupt.requested() {
                println!("\nasked");
                if role == "polite" {
                    process::exit(0);
                }
            }
        }
        process::exit(9);
    }

    /// A process that ignores these signals at its start: SIGINT as a background job of a script does.
    fn start(role: &str, ignored: &str) -> (Child, impl FnMut(&str)) {
        let mut child = Command::new("sh")
            .args(["-c", &format!("trap '' {ignored}; exec \"$@\""), "sh"])
            .arg(std::env::current_exe().unwrap())
            .args(["--nocapture", "interrupt::tests::child_process"])
            .env(ROLE, role)
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let mut lines = BufReader::new(child.stdout.take().unwrap()).lines();
        let wait_for = move |word: &str| assert!(lines.any(|line| line.unwrap() == word));
        (child, wait_for)
    }

    fn send(signal: &str, child: &Child) {
        // The shell's own kill: not every machine has the program.
        let command = format!("kill -{signal} {}", child.id());
        let status = Command::new("sh").args(["-c", &command]).status();
        assert!(status.unwrap().success());
    }

    #[test]
    fn the_first_signal_is_polled_and_the_second_exits() {
        for signal in ["INT", "TERM", "HUP"] {
            let (mut child, mut wait_for) = start("polite", "INT");
            wait_for("ready");
            send(signal, &child);
            assert_eq!(child.wait().unwrap().code(), Some(0), "{signal}");
        }
        for (signal, code) in [("INT", 130), ("TERM", 143), ("HUP", 129)] {
            let (mut child, mut wait_for) = start("deaf", "INT");
            wait_for("ready");
            send(signal, &child);
            wait_for("asked");
            send("INT", &child);
            assert_eq!(child.wait().unwrap().code(), Some(code), "{signal}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_hangup_that_is_ignored_stays_so() {
        let (mut child, mut wait_for) = start("deaf", "HUP");
        wait_for("ready");
        send("HUP", &child);
        send("TERM", &child);
        wait_for("asked");
        send("TERM", &child);
        assert_eq!(child.wait().unwrap().code(), Some(143));
    }
}
