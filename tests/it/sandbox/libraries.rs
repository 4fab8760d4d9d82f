//! The system libraries that the course's programs need.
use super::*;

/// Compiles a source in the folder of a bench. Returns `None` if there is no such compiler or library.
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

/// Returns limits that are large enough for threads and sanitizers.
fn roomy() -> Limits {
    Limits { memory: 512 << 20, processes: 40, cpu: Duration::from_secs(10), ..small() }
}

fn said(bench: &Bench, program: &Path) -> String {
    let job = bench.job(program, &[]).limits(roomy()).sanitizers(true);
    let outcome = bench.finish(&job);
    let words = text(&outcome.stdout.bytes).to_owned();
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{words}{}", String::from_utf8_lossy(&outcome.stderr.bytes));
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
    // To cancel a thread, the C library loads another library.
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
fn programs_with_sanitizers_and_without_libraries_run() {
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
    // This is the C library's own data, if it exists.
    if Path::new("/usr/lib/locale/C.utf8").exists() {
        let source = "#include <locale>\nint main() { std::locale::global(std::locale(\"C.UTF-8\")); }";
        let Some(program) = built(&bench, source, &[]) else { return };
        assert_eq!(said(&bench, &program), "");
    }
}

/// Tests timed waits for objects that processes could share, and the program's own counters.
const WAITS: &str = r#"
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <pthread.h>
#include <semaphore.h>
#include <string>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
static timespec in_ms(int clock, long ms) {
    timespec t; clock_gettime(clock, &t);
    t.tv_nsec += ms % 1000 * 1000000; t.tv_sec += ms / 1000 + t.tv_nsec / 1000000000; t.tv_nsec %= 1000000000;
    return t;
}
static double now() { timespec t; clock_gettime(CLOCK_MONOTONIC, &t); return t.tv_sec + t.tv_nsec / 1e9; }
struct Shared { pthread_mutex_t lock; pthread_cond_t ready; pthread_barrier_t barrier; sem_t count; int value; };
static Shared *shared;
static void *later(void *) { usleep(150000); return nullptr; }
static void *give(void *) {
    usleep(150000);
    sem_post(&shared->count);
    usleep(150000);
    pthread_mutex_lock(&shared->lock); shared->value = 1; pthread_cond_broadcast(&shared->ready);
    pthread_mutex_unlock(&shared->lock);
    pthread_barrier_wait(&shared->barrier);
    return nullptr;
}
int main() {
    FILE *file = fopen("shared", "w+"); ftruncate(fileno(file), 4096);
    shared = (Shared *)mmap(nullptr, 4096, PROT_READ | PROT_WRITE, MAP_SHARED, fileno(file), 0);
    if (shared == MAP_FAILED) { puts("map"); return 1; }
    pthread_mutexattr_t m; pthread_mutexattr_init(&m); pthread_mutexattr_setpshared(&m, 1);
    pthread_mutex_init(&shared->lock, &m);
    pthread_condattr_t c; pthread_condattr_init(&c); pthread_condattr_setpshared(&c, 1);
    pthread_cond_init(&shared->ready, &c);
    pthread_barrierattr_t b; pthread_barrierattr_init(&b); pthread_barrierattr_setpshared(&b, 1);
    pthread_barrier_init(&shared->barrier, &b, 2);
    sem_init(&shared->count, 1, 0);
    pthread_t thread;
    timespec limit;
    pthread_create(&thread, nullptr, later, nullptr);
    limit = in_ms(CLOCK_REALTIME, 20);
    printf("%d ", pthread_timedjoin_np(thread, nullptr, &limit) == ETIMEDOUT);
    limit = in_ms(CLOCK_REALTIME, 20000);
    printf("%d ", pthread_timedjoin_np(thread, nullptr, &limit));
    limit = in_ms(CLOCK_REALTIME, 20);
    printf("%d ", sem_timedwait(&shared->count, &limit) == -1 && errno == ETIMEDOUT);
    pthread_create(&thread, nullptr, give, nullptr);
    limit = in_ms(CLOCK_REALTIME, 20000);
    printf("%d ", sem_timedwait(&shared->count, &limit));
    pthread_mutex_lock(&shared->lock);
    limit = in_ms(CLOCK_REALTIME, 20);
    double start = now();
    printf("%d ", pthread_cond_timedwait(&shared->ready, &shared->lock, &limit) == ETIMEDOUT && now() - start > 0.019);
    limit = in_ms(CLOCK_MONOTONIC, 20000);
    while (!shared->value) if (pthread_cond_clockwait(&shared->ready, &shared->lock, CLOCK_MONOTONIC, &limit)) {
        puts("cond");
    return 1; }
    pthread_mutex_unlock(&shared->lock);
    pthread_barrier_wait(&shared->barrier);
    pthread_join(thread, nullptr);
    rusage usage;
    printf("%d ", getrusage(RUSAGE_SELF, &usage) == 0 && usage.ru_maxrss > 0
        && wait4(-1, nullptr, 0, &usage) == -1 && errno == ECHILD);
    std::string word; std::ifstream status("/proc/self/status"), statm("/proc/self/statm"), stat("/proc/self/stat");
    printf("%d\n", (status >> word) && (statm >> word) && (stat >> word) && std::stoi(word) == getpid());
}
"#;

#[test]
fn waits_with_a_limit_of_time_last_until_it_and_end_when_they_should() {
    let Some(bench) = Bench::new() else { return };
    let Some(program) = built(&bench, WAITS, &["-pthread"]) else { return };
    for backend in [bench.backend.clone(), bench.backend.without_layer(Layer::Namespaces).unwrap()] {
        let outcome = backend.start(&bench.job(&program, &[])).unwrap().wait().unwrap();
        assert_eq!((outcome.ended, text(&outcome.stdout.bytes)), (RunEnd::Exited(0), "1 0 1 0 1 1 1\n"));
    }
}

#[test]
fn a_program_reads_the_systems_libraries_and_nothing_else_of_the_system() {
    let Some(bench) = Bench::new() else { return };
    let script = bench.script(
        "#!/bin/sh\nfor file; do [ -r \"$file\" ] && { read x < \"$file\"; } 2>&- && echo \"$file\"; done\n:\n",
    );
    let others = [
        "/usr/share/zoneinfo/Europe/Berlin",
        "/usr/bin/env",
        "/etc/passwd",
        "/proc/meminfo",
        "/proc/loadavg",
        "/sys/devices/system/cpu/vulnerabilities/l1tf",
    ];
    let library = std::fs::read_dir("/usr/lib").unwrap().flatten().map(|entry| entry.path().join("libc.so.6"));
    let library = library.into_iter().find(|path| path.exists()).map(|path| path.display().to_string());
    let words: Vec<&str> = others.into_iter().chain(library.as_deref()).collect();
    for backend in [
        Ok(bench.backend.clone()),
        bench.backend.without_layer(Layer::FileRules),
        bench.backend.without_layer(Layer::Namespaces),
    ] {
        let Ok(backend) = backend else { continue };
        let outcome = backend.start(&bench.job(&script, &words)).unwrap().wait().unwrap();
        let read: Vec<&str> = text(&outcome.stdout.bytes).lines().collect();
        assert_eq!(
            (outcome.ended, read),
            (RunEnd::Exited(0), library.iter().map(String::as_str).collect()),
            "{words:?}"
        );
    }
}

/// Mounts a file system in memory, with a module of ours, over the folder of local libraries, and grades a script.
#[test]
fn our_module_for_python_is_no_library_of_a_submission() {
    let Some(_) = backend() else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let script = "#!/bin/sh\ncd /usr/local/lib/python3/dist-packages\n\
                  for file in other.py fosssim/__init__.py; do\n\
                  read word < $file; echo \"it reads $word\" >&2; word=; done\n";
    std::fs::write(at("program"), script).unwrap();
    std::fs::set_permissions(at("program"), std::fs::Permissions::from_mode(0o755)).unwrap();
    let suite =
        "schema = 1\nname = \"t\"\n[[group]]\nname = \"g\"\nscenes = [\"asset:ImpulsesTests/o*\"]\npoints = 10\n";
    std::fs::write(at("suite.toml"), suite).unwrap();
    let line = "mount -t tmpfs tmpfs /usr/local/lib && cd /usr/local/lib && mkdir -p python3/dist-packages/fosssim \
                && cd python3/dist-packages && echo answers > fosssim/__init__.py && echo others > other.py \
                && chmod -R a+rX /usr/local/lib && cd \"$0\" && \"$1\" grade program --suite suite.toml";
    let words = ["-m", "sh", "-c", line];
    let command = std::process::Command::new("unshare")
        .args(words)
        .arg(folder.path())
        .arg(env!("CARGO_BIN_EXE_fosssim-oracle"))
        .output();
    let Ok(output) = command else { return skip(Need::Walls, "there is no unshare") };
    let (out, err) = (text(&output.stdout), String::from_utf8_lossy(&output.stderr));
    if out.is_empty() {
        return skip(Need::Walls, err);
    }
    assert!(out.contains("it reads others") && !out.contains("answers"), "{out}{err}");
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
    assert_eq!(outcome.ended, RunEnd::Exited(0), "{}", String::from_utf8_lossy(&outcome.stderr.bytes));
    assert!(bench.folder.path().join("program").exists());
}
