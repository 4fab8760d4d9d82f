//! A file with options, for what does not change from start to start. What is typed goes before the environment, the
//! environment before the file, and the file before what is built in.
use super::arguments::Arguments;
use clap::{CommandFactory, FromArgMatches, builder::OsStr};
use std::{ffi::OsString, os::unix::fs::PermissionsExt, path::Path};

/// The option and the variable that name the file.
const OPTION: &str = "--config";
const VARIABLE: &str = "FOSSSIM_CONFIG";

/// Options that stand in no file: they name the file, or belong to one start.
const NEVER: [&str; 3] = ["config", "help", "version"];

/// Reads what was typed, and the file that it names.
///
/// # Errors
/// The first error in either, or the text that `--help` and `--version` print.
pub(super) fn parse(words: &[OsString]) -> Result<Arguments, clap::Error> {
    let mut command = Arguments::command();
    if let Some(file) = named(words) {
        let problem = |text: String| Arguments::command().error(clap::error::ErrorKind::Io, text);
        let file = Path::new(&file);
        let text = std::fs::read_to_string(file)
            .map_err(|error| problem(format!("cannot read the configuration {}: {error}", file.display())))?;
        let options = read(&text).map_err(|error| problem(format!("{}: {error}", file.display())))?;
        let is_open = std::fs::metadata(file).is_ok_and(|data| data.permissions().mode() & 0o077 != 0);
        if is_open && options.iter().any(|(name, value)| name == "database" && value.contains('@')) {
            eprintln!("warning: others can read the database's password in {}: chmod 600 it", file.display());
        }
        command = with_defaults(command, &options).map_err(|error| problem(format!("{}: {error}", file.display())))?;
    }
    Arguments::from_arg_matches(&command.try_get_matches_from(words)?)
}

/// The file that was typed, or that the environment names.
fn named(words: &[OsString]) -> Option<OsString> {
    let mut words = words.iter().skip(1);
    while let Some(word) = words.next() {
        if word == OPTION {
            return words.next().cloned();
        }
        if let Some(file) = word.to_str().and_then(|word| word.strip_prefix(OPTION)?.strip_prefix('=')) {
            return Some(file.into());
        }
    }
    std::env::var_os(VARIABLE).filter(|file| !file.is_empty())
}

/// Options and their values, as they would be typed.
fn read(text: &str) -> Result<Vec<(String, String)>, String> {
    let table: toml::Table = text.parse().map_err(|error: toml::de::Error| error.to_string())?;
    let value = |(name, value): (String, toml::Value)| match value {
        toml::Value::String(text) => Ok((name, text)),
        toml::Value::Integer(number) => Ok((name, number.to_string())),
        toml::Value::Boolean(flag) => Ok((name, flag.to_string())),
        _ => Err(format!("{name} is a text, a whole number, true or false")),
    };
    table.into_iter().map(value).collect()
}

/// The command line whose options begin with these values.
fn with_defaults(mut command: clap::Command, options: &[(String, String)]) -> Result<clap::Command, String> {
    let names = |command: &clap::Command| -> Vec<String> {
        command.get_arguments().filter_map(|argument| Some(argument.get_long()?.to_owned())).collect()
    };
    let mut known: Vec<String> = names(&command);
    known.extend(command.get_subcommands().flat_map(names));
    known.retain(|name| !NEVER.contains(&name.as_str()));
    known.sort();
    known.dedup();
    for (name, value) in options {
        if !known.contains(name) {
            return Err(format!("there is no option {name}; there are {}", known.join(", ")));
        }
        // Lives as long as the process, which reads one file.
        let value: OsStr = (&*Box::leak(value.clone().into_boxed_str())).into();
        let set = |command: clap::Command| {
            // Help shows what is built in, and no password.
            let own = command.get_arguments().find(|argument| argument.get_long() == Some(name)).cloned();
            match own {
                Some(argument) => command.mut_arg(argument.get_id().clone(), |argument| {
                    let hides = argument.get_action().takes_values();
                    argument.default_value(value.clone()).hide_default_value(hides)
                }),
                None => command,
            }
        };
        command = set(command).mut_subcommands(set);
    }
    Ok(command)
}

#[cfg(test)]
mod tests {
    use super::{super::arguments::Command, *};

    fn parse(words: &[&str], text: &str) -> Result<Arguments, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("fosssim.toml");
        std::fs::write(&file, text).expect("written");
        let mut words: Vec<OsString> = words.iter().map(OsString::from).collect();
        words.extend([OPTION.into(), file.into()]);
        super::parse(&words).map_err(|error| error.to_string())
    }

    fn serve(words: &[&str], text: &str) -> super::super::arguments::Serve {
        let words = [&["fosssim-server", "serve"], words].concat();
        match parse(&words, text).expect("arguments").command {
            Command::Serve(serve) => serve,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn what_is_typed_goes_before_the_file() {
        let text =
            "listen = \"0.0.0.0:80\"\nworkers = 3\nlease = 7\nexample = true\ntoken-file = \"of workers only\"\n";
        let from_file = serve(&[], text);
        assert_eq!(from_file.listen.to_string(), "0.0.0.0:80");
        assert_eq!((from_file.workers, from_file.work.lease, from_file.example), (Some(3), 7, true));
        assert_eq!(from_file.work.tries, 5, "built in");
        let typed = serve(&["--workers", "0", "--lease=9"], text);
        assert_eq!((typed.workers, typed.work.lease), (Some(0), 9));
    }

    #[test]
    fn a_worker_finds_server_and_token_wherever_they_are_said() {
        for words in [&["--server", "https://a.example"][..], &[]] {
            let words = [&["fosssim-server", "worker"], words].concat();
            let parsed = parse(&words, "token-file = \"token\"\nserver = \"https://a.example\"\n").expect("arguments");
            let Command::Worker(worker) = parsed.command else { panic!("{parsed:?}") };
            assert_eq!(worker.server.as_deref(), Some("https://a.example"));
            assert_eq!(worker.token_file.as_deref(), Some(Path::new("token")));
        }
    }

    #[test]
    fn what_is_wrong_with_a_file_is_told() {
        let error = |text: &str| parse(&["fosssim-server", "serve"], text).expect_err("wrong");
        assert!(error("lisen = \"x\"").contains("there is no option lisen; there are"), "{}", error("lisen = \"x\""));
        assert!(error("config = \"x\"").contains("no option config"));
        assert!(error("workers = [1]").contains("workers is a text, a whole number"), "{}", error("workers = [1]"));
        assert!(error("workers = \"many\"").contains("many"));
        assert!(error("lease = 0").contains("0 is not in 1..=3600"), "{}", error("lease = 0"));
        assert!(error("= 1").contains("fosssim.toml"));
        let words: Vec<OsString> = ["fosssim-server", "serve", "--config=/no/where"].map(OsString::from).into();
        let error = super::parse(&words).expect_err("no file").to_string();
        assert!(error.contains("cannot read the configuration /no/where"), "{error}");
    }

    #[test]
    fn help_shows_no_password_of_the_file() {
        let error = parse(&["fosssim-server", "serve", "--help"], "database = \"postgres://me:geheim@db/x\"\n");
        let help = error.expect_err("help comes as an error");
        assert!(help.contains("--database") && !help.contains("geheim"), "{help}");
    }
}
