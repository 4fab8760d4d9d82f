//! The server as a process, spoken to over HTTP.

mod example;
mod flows;
mod hostile;
mod roles;
mod upgrade;
mod workers;
