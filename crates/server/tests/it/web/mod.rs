//! The server as a process, spoken to over HTTP.

mod example;
mod flows;
mod hostile;
mod passwords;
mod replay;
mod roles;
mod suspicion;
mod upgrade;
mod workers;
