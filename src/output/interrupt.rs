//! Ctrl-C: the first one asks a run to stop in good order, the second one ends the program.

use std::process;
use std::sync::atomic::{AtomicBool, Ordering};

use super::OutputError;

/// Exit code of a program ended by Ctrl-C, as shells expect it (128 + SIGINT).
const EXIT_CODE: i32 = 130;

static INSTALLED: AtomicBool = AtomicBool::new(false);
static REQUESTED: AtomicBool = AtomicBool::new(false);

/// Says whether the user pressed Ctrl-C.
///
/// The run polls [`requested`](Self::requested) after every step and stops with what it has
/// computed so far; a second Ctrl-C doesn't wait for that. There is one Ctrl-C per process, so
/// all values of this type say the same.
#[derive(Debug, Clone, Copy)]
pub struct Interrupt(());

impl Interrupt {
    /// Begins to catch Ctrl-C; calling it again changes nothing.
    ///
    /// It is caught even in a background job of a script, which shells start with Ctrl-C ignored:
    /// whoever sends SIGINT to a run wants it to stop.
    ///
    /// # Errors
    /// [`OutputError::Interrupt`] if the system refuses; the run can go on without.
    pub fn install() -> Result<Self, OutputError> {
        if INSTALLED.swap(true, Ordering::SeqCst) {
            return Ok(Self(()));
        }
        ctrlc::set_handler(on_ctrl_c).map_err(|error| {
            INSTALLED.store(false, Ordering::SeqCst);
            OutputError::Interrupt { message: error.to_string() }
        })?;
        Ok(Self(()))
    }

    /// Whether Ctrl-C was pressed. Costs as much as reading a variable.
    #[inline]
    pub fn requested(self) -> bool {
        REQUESTED.load(Ordering::Relaxed)
    }
}

fn on_ctrl_c() {
    if REQUESTED.swap(true, Ordering::SeqCst) {
        process::exit(EXIT_CODE);
    }
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

    fn start(role: &str) -> (Child, impl FnMut(&str)) {
        // Started as a script starts a background job: with SIGINT ignored.
        let mut child = Command::new("sh")
            .args(["-c", "trap '' INT; exec \"$@\"", "sh"])
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

    fn press_ctrl_c(child: &Child) {
        // The shell's own kill: not every machine has the program.
        let command = format!("kill -INT {}", child.id());
        let status = Command::new("sh").args(["-c", &command]).status();
        assert!(status.unwrap().success());
    }

    #[test]
    fn first_ctrl_c_is_polled_and_second_exits() {
        let (mut child, mut wait_for) = start("polite");
        wait_for("ready");
        press_ctrl_c(&child);
        assert_eq!(child.wait().unwrap().code(), Some(0));

        let (mut child, mut wait_for) = start("deaf");
        wait_for("ready");
        press_ctrl_c(&child);
        wait_for("asked");
        press_ctrl_c(&child);
        assert_eq!(child.wait().unwrap().code(), Some(EXIT_CODE));
    }
}
