//! The server as a process, spoken to over HTTP.

mod flows;
mod hostile;
mod roles;
mod upgrade;
mod workers;
