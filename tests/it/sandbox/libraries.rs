//! The needs of the course's programs from the system's libraries, though they may read few of its files.
use super::*;

/// Compiles a source that a bench holds; `None` where there is no such compiler or library.
fn built(bench: &Bench, source: &str, words: &[&str]) -> Option<PathBuf> {
    let path = bench.folder.path().join("source.cpp");
    std::fs::write(&path, source).unwrap();
    let program = bench.folder.path().join("program");
    let output = std::process::Command::new("c++").args(["-w", "-o"]).args([&program, &path]).args(words).output();
    match output {
        Ok(output) if output.status.success() => Some(program),
        why => {
            skip(Need::Cxx, format!("c++ {words:?}: {why:?}"));
            None
        }
    }
}

/// Limits with which threads and sanitisers can do their work.
fn roomy() -> Limits {
    Limits { memory: 512 << 20, processes: 40, cpu: Duration::from_secs(10), ..small() }
}

fn said(bench: &Bench, program: &Path) -> String {
    let job = bench.job(program, &[]).limits(roomy()).sanitisers(true);
    let outcome = bench.finish(&job);
    let words = text(&outcome.stdout.bytes).to_owned();
    assert_eq!(outcome.ended, Ended::Exited(0), "{words}{}", String::from_utf8_lossy(&outcome.stderr.bytes));
    words
}

const THREADS: &str = r#"
#include <cstdio>
#include <future>
#include <mutex>
#include <pthread.h>
#include <stdexcept>
#include <thread>
#include <unistd.h>
#include <vector>
static void *sleeps(void *) { pause(); return nullptr; }
int main() {
    long sum = 0;
    std::mutex lock;
    std::vector<std::thread> threads;
    for (int i = 0; i < 8; i++) threads.emplace_back([&, i] {
        usleep(1000 * i);
        std::lock_guard<std::mutex> guard(lock);
        sum += i;
    });
    for (auto &thread : threads) thread.join();
    // To end a thread on request the C library loads another library.
    pthread_t waiting;
    pthread_create(&waiting, nullptr, sleeps, nullptr);
    pthread_cancel(waiting);
    void *result = nullptr;
    pthread_join(waiting, &result);
    auto failed = std::async(std::launch::async, [] { throw std::runtime_error("thrown"); });
    try { failed.get(); } catch (std::exception &error) { printf("%s ", error.what()); }
    printf("%ld %d\n", sum, result == PTHREAD_CANCELED);
}
"#;

#[test]
fn threads_begin_end_and_are_waited_for() {
    let Some(bench) = Bench::new() else { return };
    for words in [&["-pthread"][..], &["-pthread", "-static-libstdc++"]] {
        let Some(program) = built(&bench, THREADS, words) else { continue };
        assert_eq!(said(&bench, &program), "thrown 28 1\n", "{words:?}");
    }
}

#[test]
fn programs_with_sanitisers_and_without_libraries_run() {
    let Some(bench) = Bench::new() else { return };
    for words in [
        &["-pthread", "-fsanitize=address"][..],
        &["-pthread", "-fsanitize=undefined"],
        &["-pthread", "-static", "-Wl,--whole-archive", "-lpthread", "-Wl,--no-whole-archive"],
    ] {
        let Some(program) = built(&bench, THREADS, words) else { continue };
        assert_eq!(said(&bench, &program), "thrown 28 1\n", "{words:?}");
    }
}

#[test]
fn parallel_loops_run() {
    const LOOPS: &str = r#"
#include <cstdio>
int main() {
    long sum = 0;
    for (int round = 0; round < 50; round++) {
        #pragma omp parallel for reduction(+:sum) num_threads(4)
        for (int i = 0; i < 1000; i++) sum += i;
    }
    printf("%ld\n", sum);
}
"#;
    let Some(bench) = Bench::new() else { return };
    let Some(program) = built(&bench, LOOPS, &["-fopenmp"]) else { return };
    assert_eq!(said(&bench, &program), "24975000\n");
}

#[test]
fn locales_character_sets_clocks_and_sorting_work() {
    const LIBRARY: &str = r#"
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <clocale>
#include <iconv.h>
#include <thread>
#include <unistd.h>
#include <vector>
static int less(const void *a, const void *b) { return *(const int *)a - *(const int *)b; }
int main() {
    char from[] = "\xe4", to[8] = {0}, *in = from, *out = to;
    size_t left = 1, room = 7;
    iconv_t utf8 = iconv_open("UTF-8", "ISO-8859-1");
    if (utf8 == (iconv_t)-1 || iconv(utf8, &in, &left, &out, &room) == (size_t)-1) puts("no conversion");
    std::vector<int> numbers(100000);
    for (size_t i = 0; i < numbers.size(); i++) numbers[i] = (i * 7919) % 100000;
    qsort(numbers.data(), numbers.size(), sizeof(int), less);
    if (!std::is_sorted(numbers.begin(), numbers.end())) puts("not sorted");
    if (clock() < 0 || time(nullptr) == 0) puts("no clock");
    timespec now;
    if (clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now)) puts("no time of the thread");
    clockid_t own;
    if (clock_getcpuclockid(getpid(), &own) || clock_gettime(own, &now)) puts("no time of the process");
    if (pthread_getcpuclockid(pthread_self(), &own) || clock_gettime(own, &now)) puts("no time of a thread by number");
    time_t start = 0;
    if (!localtime(&start)) puts("no time zone");
    if (sysconf(_SC_PHYS_PAGES) <= 0 || std::thread::hardware_concurrency() == 0) puts("no machine");
    printf("%s\n", to);
}
"#;
    let Some(bench) = Bench::new() else { return };
    let Some(program) = built(&bench, LIBRARY, &["-pthread"]) else { return };
    assert_eq!(said(&bench, &program), "\u{e4}\n");
    // The C library's own data, if it is there.
    if Path::new("/usr/lib/locale/C.utf8").exists() {
        let source = "#include <locale>\nint main() { std::locale::global(std::locale(\"C.UTF-8\")); }";
        let Some(program) = built(&bench, source, &[]) else { return };
        assert_eq!(said(&bench, &program), "");
    }
}

#[test]
fn a_program_reads_the_libraries_that_it_loads_and_no_others() {
    let Some(bench) = Bench::new() else { return };
    let script = bench.script(
        "#!/bin/sh\nfor file; do [ -r \"$file\" ] && { read x < \"$file\"; } 2>&- && echo \"$file\"; done\n:\n",
    );
    let others = [
        "/usr/share/zoneinfo/Europe/Berlin",
        "/proc/meminfo",
        "/proc/loadavg",
        "/sys/devices/system/cpu/vulnerabilities/l1tf",
    ];
    let mut others = others.map(str::to_owned).to_vec();
    let folders = ["/usr/lib/gcc", "/usr/lib/x86_64-linux-gnu"].iter().flat_map(std::fs::read_dir);
    let needed = ["libc.so.6", "ld-linux", "libgcc_s"];
    let is_other = |name: &str| !needed.iter().any(|needed| name.contains(needed));
    others.extend(
        folders
            .flatten()
            .flatten()
            .map(|entry| entry.path().display().to_string())
            .filter(|path| is_other(path))
            .take(80),
    );
    let words: Vec<&str> = others.iter().map(String::as_str).collect();
    for backend in
        [Ok(bench.backend.clone()), bench.backend.without(Layer::FileRules), bench.backend.without(Layer::Namespaces)]
    {
        let Ok(backend) = backend else { continue };
        let outcome = backend.start(&bench.job(&script, &words)).unwrap().wait().unwrap();
        assert_eq!((outcome.ended, text(&outcome.stdout.bytes)), (Ended::Exited(0), ""), "{words:?}");
    }
}

#[test]
fn build_steps_have_threads_jobs_and_the_compilers_folders() {
    let Some(bench) = Bench::new() else { return };
    if std::process::Command::new("make").arg("--version").output().is_err() {
        skip(Need::Make, "there is no make");
        return;
    }
    let put = |name: &str, text: &str| std::fs::write(bench.folder.path().join(name), text).unwrap();
    put("a.cpp", "#include <thread>\nint other(); int main() { std::thread t([] {}); t.join(); return other(); }\n");
    put("b.cpp", "#include <map>\nint other() { std::map<int, int> m; return m[3]; }\n");
    put(
        "Makefile",
        "all: program\n\t./program\nprogram: a.o b.o\n\tc++ -pthread -o $@ $^\n%.o: %.cpp\n\tc++ -O1 -c $<\n",
    );
    let limits = Limits { memory: 1 << 30, folder_bytes: 64 << 20, cpu: Duration::from_secs(60), ..roomy() };
    let limits = Limits { wall: Duration::from_secs(120), open_files: 256, ..limits };
    let job = bench.job("/usr/bin/make", &["-j2"]).policy(Policy::Tools).limits(limits);
    let outcome = bench.finish(&job);
    assert_eq!(outcome.ended, Ended::Exited(0), "{}", String::from_utf8_lossy(&outcome.stderr.bytes));
    assert!(bench.folder.path().join("program").exists());
}
