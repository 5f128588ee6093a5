/* Plays hosts that are not as most are: with little stack, little memory, other floating-point
 * environments, no threads to give, that fork, and that unload the library.
 *
 * Arguments: what to play, library, version (2 or 3), URI or path of the resources, GUID, value
 * reference of the number of threads, step, and value references of outputs. Prints the bits of the
 * outputs, a line for each run, and answers 0 if all else is as it should be.
 */
#define _GNU_SOURCE
#include <impinge.h>
#include <impinge_fmi3.h>

#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fenv.h>
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#define EXPECT(condition)                                                  \
  do {                                                                     \
    if (!(condition)) {                                                    \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
      exit(1);                                                             \
    }                                                                      \
  } while (0)

enum { STEPS = 3, THREADS = 3 };

static const char *path, *resources, *guid;
static int version, count;
static unsigned threads, outputs[64];
static double size;
static void *library;

#define FUNCTION(name) ((__typeof__(name) *)dlsym(library, #name))

static void load(void) {
  library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) {
    fprintf(stderr, "%s\n", dlerror());
    exit(1);
  }
}

/* The system's threads, until there are to be no more of them. */
static int threads_left = 1 << 30;

/* A place where a thread waits for another one to fork: none, waited for, reached, left. */
enum { NOWHERE, AWAITED, REACHED, LEFT };
static int place = NOWHERE;
/* How many starts of threads come before the place; none is one if it is below zero. */
static int starts_before = -1;
/* Whether this thread is starting one, and whether what is freed then is the place. */
static __thread int starting;
static int freeing;

static void wait_for_a_fork(void) {
  int expected = AWAITED;
  if (__atomic_compare_exchange_n(&place, &expected, REACHED, 0, __ATOMIC_SEQ_CST,
                                  __ATOMIC_SEQ_CST)) {
    while (__atomic_load_n(&place, __ATOMIC_SEQ_CST) != LEFT) {
      usleep(100);
    }
  }
}

static int is_forked;

#ifdef __GLIBC__
extern void __libc_free(void *);

/* What was freed last at the place, whose thread a forked process does not have: who frees it there does so again. */
static void *freed;

void free(void *block) {
  EXPECT(!is_forked || block == NULL || block != freed);
  __libc_free(block);
  if (block != NULL && starting && __atomic_load_n(&freeing, __ATOMIC_SEQ_CST) &&
      __atomic_load_n(&place, __ATOMIC_SEQ_CST) == AWAITED) {
    freed = block;
    wait_for_a_fork();
  }
}
#endif

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*body)(void *),
                   void *argument) {
  __typeof__(pthread_create) *real =
      (__typeof__(pthread_create) *)dlsym(RTLD_NEXT, "pthread_create");
  if (__atomic_sub_fetch(&threads_left, 1, __ATOMIC_SEQ_CST) < 0) {
    return EAGAIN;
  }
  if (__atomic_load_n(&place, __ATOMIC_SEQ_CST) == AWAITED &&
      __atomic_fetch_sub(&starts_before, 1, __ATOMIC_SEQ_CST) == 0) {
    wait_for_a_fork();
  }
  starting = 1;
  const int failed = real(thread, attributes, body, argument);
  starting = 0;
  return failed;
}

/* What the logger has found the rounding to be. */
static int rounding_seen = -1;

static int refusing;

static void listen2(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                    fmi2String category, fmi2String format, ...) {
  (void)environment, (void)instance, (void)category;
  rounding_seen = fegetround();
  if (status >= fmi2Error && !refusing) {
    fprintf(stderr, "%s\n", format);
  }
}

static void listen3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                    fmi3String message) {
  (void)environment, (void)category;
  rounding_seen = fegetround();
  if (status >= fmi3Error && !refusing) {
    fprintf(stderr, "%s\n", message);
  }
}

static const fmi2CallbackFunctions callbacks = {listen2, NULL, NULL, NULL, NULL};

/* Whether even inexact arithmetic is trapped while an instance is made. */
static bool trapping_all;

static void *begin(void) {
  const int wanted = THREADS;
  void *unit;
  if (trapping_all) {
    feclearexcept(FE_INEXACT);
    feenableexcept(FE_INEXACT);
  }
  if (version == 2) {
    unit = FUNCTION(fmi2Instantiate)("host", fmi2CoSimulation, guid, resources, &callbacks, 0, 1);
    fedisableexcept(FE_INEXACT);
    EXPECT(unit != NULL);
    EXPECT(FUNCTION(fmi2SetupExperiment)(unit, 0, 0.0, 0.0, 0, 0.0) == fmi2OK);
    EXPECT(FUNCTION(fmi2SetInteger)(unit, &threads, 1, &wanted) == fmi2OK);
    EXPECT(FUNCTION(fmi2EnterInitializationMode)(unit) == fmi2OK);
    EXPECT(FUNCTION(fmi2ExitInitializationMode)(unit) == fmi2OK);
  } else {
    unit = FUNCTION(fmi3InstantiateCoSimulation)("host", guid, resources, false, true, false, false,
                                                 NULL, 0, NULL, listen3, NULL);
    fedisableexcept(FE_INEXACT);
    EXPECT(unit != NULL);
    EXPECT(FUNCTION(fmi3SetInt32)(unit, &threads, 1, &wanted, 1) == fmi3OK);
    EXPECT(FUNCTION(fmi3EnterInitializationMode)(unit, false, 0.0, 0.0, false, 0.0) == fmi3OK);
    EXPECT(FUNCTION(fmi3ExitInitializationMode)(unit) == fmi3OK);
  }
  return unit;
}

static void read_outputs(void *unit, double *values) {
  if (version == 2) {
    EXPECT(FUNCTION(fmi2GetReal)(unit, outputs, count, values) == fmi2OK);
  } else {
    EXPECT(FUNCTION(fmi3GetFloat64)(unit, outputs, count, values, count) == fmi3OK);
  }
}

static void steps(void *unit, double *values) {
  for (int k = 0; k < STEPS; k++) {
    bool events, end, early;
    double reached;
    if (version == 2) {
      EXPECT(FUNCTION(fmi2DoStep)(unit, k * size, size, 1) == fmi2OK);
    } else {
      EXPECT(FUNCTION(fmi3DoStep)(unit, k * size, size, true, &events, &end, &early, &reached) ==
             fmi3OK);
    }
  }
  read_outputs(unit, values);
}

/* Saves and goes back by way of bytes, and asks how outputs change, which not every unit tells. */
static void ask(void *unit) {
  const int32_t firsts[64] = {[0 ... 63] = 1};
  double rates[64];
  char *bytes;
  size_t length;
  void *state = NULL, *copy = NULL;
  refusing = 1;
  if (version == 2) {
    EXPECT(FUNCTION(fmi2GetFMUstate)(unit, &state) == fmi2OK);
    EXPECT(FUNCTION(fmi2SerializedFMUstateSize)(unit, state, &length) == fmi2OK);
    bytes = malloc(length);
    EXPECT(FUNCTION(fmi2SerializeFMUstate)(unit, state, bytes, length) == fmi2OK);
    EXPECT(FUNCTION(fmi2DeSerializeFMUstate)(unit, bytes, length, &copy) == fmi2OK);
    EXPECT(FUNCTION(fmi2SetFMUstate)(unit, copy) == fmi2OK);
    FUNCTION(fmi2GetRealOutputDerivatives)(unit, outputs, count, firsts, rates);
  } else {
    EXPECT(FUNCTION(fmi3GetFMUState)(unit, &state) == fmi3OK);
    EXPECT(FUNCTION(fmi3SerializedFMUStateSize)(unit, state, &length) == fmi3OK);
    bytes = malloc(length);
    EXPECT(FUNCTION(fmi3SerializeFMUState)(unit, state, (void *)bytes, length) == fmi3OK);
    EXPECT(FUNCTION(fmi3DeserializeFMUState)(unit, (void *)bytes, length, &copy) == fmi3OK);
    EXPECT(FUNCTION(fmi3SetFMUState)(unit, copy) == fmi3OK);
    FUNCTION(fmi3GetOutputDerivatives)(unit, outputs, count, firsts, rates, count);
  }
  refusing = 0;
  free(bytes);
}

/* Asks for what is refused, which the logger is told, and frees. */
static void end(void *unit) {
  refusing = 1;
  if (version == 2) {
    EXPECT(FUNCTION(fmi2CancelStep)(unit) == fmi2Error);
    FUNCTION(fmi2FreeInstance)(unit);
  } else {
    EXPECT(FUNCTION(fmi3EnterEventMode)(unit) == fmi3Error);
    FUNCTION(fmi3FreeInstance)(unit);
  }
  refusing = 0;
}

static void print(const double *values) {
  for (int i = 0; i < count; i++) {
    unsigned long long bits;
    memcpy(&bits, &values[i], sizeof bits);
    printf("%016llx ", bits);
  }
  printf("\n");
  fflush(stdout);
}

/* A whole life, whose outputs are printed. */
static void *live(void *unused) {
  double values[64];
  void *unit = begin();
  steps(unit, values);
  ask(unit);
  read_outputs(unit, values);
  end(unit);
  print(values);
  return unused;
}

static void on_thread(size_t stack) {
  pthread_attr_t attributes;
  pthread_t thread;
  EXPECT(pthread_attr_init(&attributes) == 0);
  EXPECT(pthread_attr_setstacksize(&attributes, stack) == 0);
  EXPECT(pthread_create(&thread, &attributes, live, NULL) == 0);
  EXPECT(pthread_join(thread, NULL) == 0);
}

static int tasks(void) {
  int found = 0;
  DIR *folder = opendir("/proc/self/task");
  for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
    found += entry->d_name[0] != '.';
  }
  closedir(folder);
  return found;
}

/* The system counts a thread for a moment after it has ended. */
static void expect_no_thread(int before) {
  for (int k = 0; k < 1000 && tasks() > before; k++) {
    usleep(1000);
  }
  EXPECT(tasks() == before);
}

static int is_mapped(void) {
  char line[4096];
  int found = 0;
  FILE *maps = fopen("/proc/self/maps", "r");
  while (fgets(line, sizeof line, maps) != NULL) {
    found |= strstr(line, path) != NULL;
  }
  fclose(maps);
  return found;
}

static void *live_and_unload(void *unused) {
  load();
  live(NULL);
  EXPECT(is_mapped());
  EXPECT(dlclose(library) == 0);
  EXPECT(!is_mapped());
  return unused;
}

/* Loads and unloads on this thread and on another, which lives on afterwards. */
static void unload(void) {
  pthread_t thread;
  for (int k = 0; k < 2; k++) {
    live_and_unload(NULL);
    EXPECT(pthread_create(&thread, NULL, live_and_unload, NULL) == 0);
    EXPECT(pthread_join(thread, NULL) == 0);
    expect_no_thread(1);
  }
}

/* What is limited: address space, or that part of it which may be written to. */
static int limited = RLIMIT_AS;

static size_t address_space(void) {
  size_t all = 0, writable = 0;
  FILE *sizes = fopen("/proc/self/statm", "r");
  EXPECT(fscanf(sizes, "%zu %*u %*u %*u %*u %zu", &all, &writable) == 2);
  fclose(sizes);
  return (limited == RLIMIT_DATA ? writable : all) * (size_t)sysconf(_SC_PAGESIZE);
}

static void in_little_space(size_t more) {
  const size_t most = address_space() + more;
  const struct rlimit limit = {most, most};
  EXPECT(setrlimit(limited, &limit) == 0);
  live(NULL);
}

/* What may be refused for want of memory ends the process as success; all else goes on. */
static void or_refused(int status) {
  if (status == fmi2Discard || status == fmi2Error) {
    _exit(0);
  }
  EXPECT(status <= fmi2Warning);
}

static size_t space_left;
static int space_from;

static void limit_space(int place) {
  const size_t most = address_space() + space_left;
  const struct rlimit limit = {most, most};
  if (place == space_from) {
    EXPECT(setrlimit(limited, &limit) == 0);
    space_from = -1;
  }
}

/* A life with little address space from some moment on, any call of which may be refused. */
static void live_or_be_refused(void) {
  const int wanted = THREADS;
  double values[64];
  void *unit, *state = NULL;
  refusing = 1;
  limit_space(0);
  if (version == 2) {
    unit = FUNCTION(fmi2Instantiate)("host", fmi2CoSimulation, guid, resources, &callbacks, 0, 1);
    or_refused(unit == NULL ? fmi2Error : fmi2OK);
    or_refused(FUNCTION(fmi2SetupExperiment)(unit, 0, 0.0, 0.0, 0, 0.0));
    or_refused(FUNCTION(fmi2SetInteger)(unit, &threads, 1, &wanted));
    or_refused(FUNCTION(fmi2EnterInitializationMode)(unit));
    or_refused(FUNCTION(fmi2ExitInitializationMode)(unit));
    limit_space(1);
    for (int k = 0; k < STEPS; k++) {
      or_refused(FUNCTION(fmi2DoStep)(unit, k * size, size, 1));
      limit_space(2);
      or_refused(FUNCTION(fmi2GetReal)(unit, outputs, count, values));
    }
    or_refused(FUNCTION(fmi2GetFMUstate)(unit, &state));
    or_refused(FUNCTION(fmi2SetFMUstate)(unit, state));
    FUNCTION(fmi2FreeInstance)(unit);
  } else {
    bool events, ends, early;
    double reached;
    unit = FUNCTION(fmi3InstantiateCoSimulation)("host", guid, resources, false, true, false, false,
                                                 NULL, 0, NULL, listen3, NULL);
    or_refused(unit == NULL ? fmi2Error : fmi2OK);
    or_refused(FUNCTION(fmi3SetInt32)(unit, &threads, 1, &wanted, 1));
    or_refused(FUNCTION(fmi3EnterInitializationMode)(unit, false, 0.0, 0.0, false, 0.0));
    or_refused(FUNCTION(fmi3ExitInitializationMode)(unit));
    limit_space(1);
    for (int k = 0; k < STEPS; k++) {
      or_refused(FUNCTION(fmi3DoStep)(unit, k * size, size, true, &events, &ends, &early, &reached));
      limit_space(2);
      or_refused(FUNCTION(fmi3GetFloat64)(unit, outputs, count, values, count));
    }
    or_refused(FUNCTION(fmi3GetFMUState)(unit, &state));
    or_refused(FUNCTION(fmi3SetFMUState)(unit, state));
    FUNCTION(fmi3FreeInstance)(unit);
  }
}

/* Processes with little address space, none of which may end but by itself: with all sizes from the
 * beginning on, with the smallest ones and the largest from later moments on. Answers how many were refused
 * nothing; the largest is enough from each moment on. */
static void sweep(void) {
  const size_t fine[] = {64, 256, 512, 1024, 2048, 3072, 6144, 8192};
  int complete = 0;
  /* Of the coarse sizes one in eight, unless all are wanted. */
  const int stride = getenv("SWEEP_ALL") ? 1 : 8;
  alarm(300);
  for (int from = 0; from < 3; from++) {
    for (int k = 0; k < 8 + 39; k++) {
      if (k >= 8 && k < 8 + 38 && (from > 0 || (k - 8) % stride)) continue;
      space_left = k < 8 ? fine[k] << 10 : (size_t)(4 + 4 * (k - 7)) * 1000000;
      space_from = from;
      const pid_t child = fork();
      int status;
      if (child == 0) {
        live_or_be_refused();
        _exit(7);
      }
      EXPECT(waitpid(child, &status, 0) == child);
      const int ended = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      if (ended != 0 && ended != 7) {
        fprintf(stderr, "%zu bytes from moment %d on: status %x\n", space_left, from, status);
      }
      complete += ended == 7;
      EXPECT(k < 8 + 38 || ended == 7);
    }
  }
  printf("%d\n", complete);
}

/* Bytes that the C library has handed out and not got back. */
static size_t allocated(void) {
  const struct mallinfo2 memory = mallinfo2();
  return memory.uordblks + memory.hblkhd;
}

/* Expects that no load leaves memory behind, nor a key for what threads keep: a process has few. */
static void again_and_again(void) {
  pthread_key_t before, after;
  size_t bytes[8];
  EXPECT(pthread_key_create(&before, NULL) == 0 && pthread_key_delete(before) == 0);
  for (int k = 0; k < 8; k++) {
    live_and_unload(NULL);
    bytes[k] = allocated();
  }
  if (bytes[7] != bytes[3]) {
    fprintf(stderr, "%zu bytes are lost in four loads\n", bytes[7] - bytes[3]);
    exit(1);
  }
  EXPECT(pthread_key_create(&after, NULL) == 0);
  EXPECT(after == before);
}

static void expect_success(pid_t child) {
  int status;
  EXPECT(waitpid(child, &status, 0) == child);
  EXPECT(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

/* A child goes on with the parent's instance, and begins its own. */
static void forked(void) {
  double values[64];
  live(NULL);
  void *unit = begin();
  const pid_t child = fork();
  alarm(120);
  if (child > 0) {
    expect_success(child);
  }
  steps(unit, values);
  print(values);
  live(NULL);
  end(unit);
  if (child == 0) {
    exit(0);
  }
}

static void *live_often(void *unused) {
  for (int k = 0; k < 8; k++) {
    void *unit = begin();
    end(unit);
  }
  return unused;
}

/* Forks while another thread is within calls. */
static void forked_within_calls(void) {
  pthread_t thread;
  alarm(120);
  /* A host makes its first unit before it forks. */
  end(begin());
  EXPECT(pthread_create(&thread, NULL, live_often, NULL) == 0);
  for (int k = 0; k < 8; k++) {
    const pid_t child = fork();
    if (child == 0) {
      alarm(120);
      live(NULL);
      _exit(0);
    }
    expect_success(child);
  }
  EXPECT(pthread_join(thread, NULL) == 0);
}

static void *live_quietly(void *finished) {
  double values[64];
  void *unit = begin();
  steps(unit, values);
  end(unit);
  __atomic_store_n((int *)finished, 1, __ATOMIC_SEQ_CST);
  return NULL;
}

static void *stay(void *until) {
  while (!__atomic_load_n((int *)until, __ATOMIC_SEQ_CST)) {
    usleep(100);
  }
  return NULL;
}

/* Starts so many threads at once that all stacks are taken that the C library keeps for later ones. */
static void take_kept_stacks(void) {
  pthread_attr_t attributes;
  pthread_t all[16];
  int over = 0;
  EXPECT(pthread_attr_init(&attributes) == 0);
  EXPECT(pthread_attr_setstacksize(&attributes, (size_t)2 << 20) == 0);
  for (int k = 0; k < 16; k++) {
    EXPECT(pthread_create(&all[k], &attributes, stay, &over) == 0);
  }
  __atomic_store_n(&over, 1, __ATOMIC_SEQ_CST);
  for (int k = 0; k < 16; k++) {
    EXPECT(pthread_join(all[k], NULL) == 0);
  }
}

/* Forks while another thread, which lives a life meanwhile, is at the place. The child goes on with an instance that nobody
 * calls, frees it and begins its own. Answers whether the place was reached. */
static int forked_at_place(const double *expected) {
  double values[64];
  pthread_t thread;
  int finished = 0;
  void *idle = begin();
  EXPECT(pthread_create(&thread, NULL, live_quietly, &finished) == 0);
  __atomic_store_n(&place, AWAITED, __ATOMIC_SEQ_CST);
  while (__atomic_load_n(&place, __ATOMIC_SEQ_CST) != REACHED &&
         !__atomic_load_n(&finished, __ATOMIC_SEQ_CST)) {
    usleep(100);
  }
  const int reached = __atomic_load_n(&place, __ATOMIC_SEQ_CST) == REACHED;
  const pid_t child = reached ? fork() : 0;
  if (reached && child == 0) {
    place = NOWHERE;
    is_forked = 1;
    alarm(60);
    take_kept_stacks();
    steps(idle, values);
    EXPECT(memcmp(values, expected, count * sizeof *values) == 0);
    end(idle);
    void *unit = begin();
    steps(unit, values);
    EXPECT(memcmp(values, expected, count * sizeof *values) == 0);
    end(unit);
    _exit(0);
  }
  if (reached) {
    expect_success(child);
  }
  __atomic_store_n(&place, LEFT, __ATOMIC_SEQ_CST);
  EXPECT(pthread_join(thread, NULL) == 0);
  end(idle);
  return reached;
}

/* Forks at every moment at which another thread has the library start one, and where the C library frees something then. */
static void forked_at_starts(void) {
  double expected[64];
  int starts = 0;
  void *unit = begin();
  steps(unit, expected);
  end(unit);
  const int most = getenv("SWEEP_ALL") ? 40 : 5;
  while (starts < most) {
    starts_before = starts;
    if (!forked_at_place(expected)) {
      break;
    }
    starts++;
  }
  EXPECT(starts > 2);
  starts_before = -1;
  freeing = 1;
  forked_at_place(expected);
  print(expected);
}

/* Runs with what is set up before, and expects to find it afterwards and in the logger. */
static void with_environment(void) {
  /* The host's own arithmetic is inexact. */
  const int flags = FE_ALL_EXCEPT & ~FE_INEXACT;
  const int traps = fegetexcept(), raised = fetestexcept(flags), rounding = fegetround();
  live(NULL);
  EXPECT(fegetexcept() == traps && fetestexcept(flags) == raised && fegetround() == rounding);
  EXPECT(rounding_seen == rounding);
}

static pid_t host;
static volatile int ticks, strayed;

static void tick(int number) {
  (void)number;
  ticks++;
  strayed += (pid_t)syscall(SYS_gettid) != host;
}

/* Its timer interrupts the host's thread often, and no other; nothing else of signals changes. */
static void with_timer(void) {
  const struct itimerval often = {{0, 200}, {0, 200}}, never = {{0, 0}, {0, 0}};
  struct sigaction action = {.sa_handler = tick}, before[NSIG], after;
  sigset_t blocked;
  stack_t stack;
  host = getpid();
  EXPECT(sigaction(SIGALRM, &action, NULL) == 0);
  for (int k = 1; k < NSIG; k++) {
    sigaction(k, NULL, &before[k]);
  }
  EXPECT(setitimer(ITIMER_REAL, &often, NULL) == 0);
  live(NULL);
  EXPECT(setitimer(ITIMER_REAL, &never, NULL) == 0);
  EXPECT(ticks > 0 && strayed == 0);
  for (int k = 1; k < NSIG; k++) {
    EXPECT(sigaction(k, NULL, &after) != 0 || after.sa_handler == before[k].sa_handler);
  }
  EXPECT(pthread_sigmask(SIG_BLOCK, NULL, &blocked) == 0 && sigisemptyset(&blocked));
  EXPECT(sigaltstack(NULL, &stack) == 0 && (stack.ss_flags & SS_DISABLE));
}

int main(int argc, char **argv) {
  EXPECT(argc > 8);
  const char *play = argv[1];
  path = argv[2];
  version = atoi(argv[3]);
  resources = argv[4];
  guid = argv[5];
  threads = (unsigned)atoi(argv[6]);
  size = atof(argv[7]);
  for (int i = 8; i < argc; i++) {
    outputs[count++] = (unsigned)atoi(argv[i]);
  }
  if (strcmp(play, "unload") == 0) {
    unload();
    return 0;
  }
  if (strcmp(play, "again") == 0) {
    again_and_again();
    return 0;
  }
  load();
  if (strcmp(play, "plain") == 0) {
    live(NULL);
  } else if (strcmp(play, "stack") == 0) {
    on_thread(64 << 10);
  } else if (strcmp(play, "space") == 0) {
    in_little_space((size_t)64 << 20);
  } else if (strcmp(play, "sweep") == 0) {
    sweep();
  } else if (strcmp(play, "sweep of data") == 0) {
    limited = RLIMIT_DATA;
    sweep();
  } else if (strcmp(play, "little stack") == 0) {
    on_thread(24 << 10);
  } else if (strcmp(play, "no threads") == 0) {
    threads_left = 0;
    live(NULL);
    threads_left = 2;
    live(NULL);
  } else if (strcmp(play, "fork") == 0) {
    forked();
  } else if (strcmp(play, "fork at starts") == 0) {
    forked_at_starts();
  } else if (strcmp(play, "fork within calls") == 0) {
    forked_within_calls();
  } else if (strcmp(play, "traps") == 0) {
    feenableexcept(FE_ALL_EXCEPT & ~FE_INEXACT);
    trapping_all = true;
    with_environment();
  } else if (strcmp(play, "rounding") == 0) {
    const int roundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};
    for (int k = 0; k < 4; k++) {
      EXPECT(fesetround(roundings[k]) == 0);
      with_environment();
    }
#ifdef __x86_64__
  } else if (strcmp(play, "flushing") == 0) {
    __builtin_ia32_ldmxcsr(0x9fc0);
    with_environment();
#endif
  } else if (strcmp(play, "timer") == 0) {
    with_timer();
  } else {
    EXPECT(!"known");
  }
  return 0;
}
