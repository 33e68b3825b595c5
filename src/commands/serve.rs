//! `ropewalk view DIR --serve`: the page of a run that still goes on, for a browser on this machine.

use super::view::open;
use super::{Exit, say, warn};
use ropewalk_report::{OutputError, Watch};
use ropewalk_studies::Error;
use ropewalk_studies::run::{compare, page_of};
use std::io::{self, IsTerminal, Read, Write};
use std::net::{Ipv4Addr, TcpListener, TcpStream};
use std::path::PathBuf;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// How often the browser asks for the page of a run that goes on [s].
const EVERY: u32 = 5;
/// How long one that doesn't say what it wants is listened to.
const PATIENCE: Duration = Duration::from_secs(2);
/// How often Ctrl-C is looked for.
const LOOK: Duration = Duration::from_millis(100);

/// Serves the page of a run, or of two, until a signal comes. Nothing but this machine can reach it.
pub(super) fn serve(folders: &[PathBuf], port: u16, show: bool) -> Result<Exit, Error> {
    // what is wrong with the folder is said at once
    page(folders)?;
    let cannot = OutputError::io("serve", &folders[0]);
    let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, port));
    let listener = listener.and_then(|l| l.set_nonblocking(true).map(|()| l)).map_err(cannot)?;
    let address = listener.local_addr().map_err(OutputError::io("serve", &folders[0]))?;
    say(format!("http://{address}/ until Ctrl-C"));
    if show && io::stdout().is_terminal() {
        open(format!("http://{address}/").as_ref());
    }
    let watch = Watch::signals(warn);
    while !watch.is_over() {
        match listener.accept() {
            Ok((stream, _)) => {
                // a browser that goes away is nobody's business
                let _ = answer(stream, folders, &address.to_string());
            }
            Err(_) => sleep(LOOK),
        }
    }
    Ok(Exit::Done)
}

/// The page as it is now, and whether more is to come.
fn page(folders: &[PathBuf]) -> Result<(String, bool), Error> {
    let going = folders.iter().any(|folder| !folder.join("summary.json").exists());
    let page = match folders {
        [a, b] => compare([a, b])?,
        [folder, ..] => page_of(folder)?,
        [] => unreachable!("one folder is required"),
    };
    Ok((page.html()?, going))
}

fn answer(mut stream: TcpStream, folders: &[PathBuf], address: &str) -> io::Result<()> {
    stream.set_nonblocking(false)?;
    stream.set_read_timeout(Some(PATIENCE))?;
    stream.set_write_timeout(Some(Duration::from_secs(30)))?;
    let (mut request, mut chunk, since) = (Vec::new(), [0; 1024], Instant::now());
    while !request.windows(4).any(|w| w == b"\r\n\r\n")
        && request.len() < 16_384
        && since.elapsed() < PATIENCE
    {
        match stream.read(&mut chunk)? {
            0 => break,
            n => request.extend(&chunk[..n]),
        }
    }
    let request = String::from_utf8_lossy(&request);
    // a page of elsewhere that has its name resolved to this machine doesn't know the address
    let host = request
        .lines()
        .find_map(|line| line.split_once(": ").filter(|(k, _)| k.eq_ignore_ascii_case("host")));
    let known = |host: &str| host == address || host == address.replace("127.0.0.1", "localhost");
    let (status, refresh, body) = if !host.is_some_and(|(_, host)| known(host.trim())) {
        ("403 Forbidden", false, "this server is for the address that it told".to_string())
    } else if !request.starts_with("GET / ") {
        ("404 Not Found", false, "there is one page here: /".to_string())
    } else {
        match page(folders) {
            Ok((html, going)) => ("200 OK", going, html),
            Err(e) => ("500 Internal Server Error", true, e.to_string()),
        }
    };
    let kind = if status.starts_with("200") { "text/html" } else { "text/plain" };
    let again = if refresh { format!("Refresh: {EVERY}\r\n") } else { String::new() };
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {kind}; charset=utf-8\r\nContent-Length: {}\r\n{again}Cache-Control: no-store\r\n\
         X-Content-Type-Options: nosniff\r\nConnection: close\r\n\r\n",
        body.len()
    )?;
    stream.write_all(body.as_bytes())
}
