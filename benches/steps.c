/* Times a unit of FMI 2.0 through its library: initialisation, steps by themselves, and steps with readings.
 *
 * Arguments: library, URI of the resources, GUID, communication step [s], number of steps, then value references: how many
 * inputs, these with a value each, and the outputs. An input is set anew every 20 steps, to parts of its value in turn.
 * Prints seconds to initialise, seconds per step, per step with readings, and kilobytes in use before and after. */
#define _POSIX_C_SOURCE 200809L
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

enum { HELD = 20, MOST = 64, TIMINGS = 5 };

typedef void *Unit;
typedef int (*Simple)(Unit);
typedef struct {
  void (*logger)(void *, const char *, int, const char *, const char *, ...);
  void *(*allocate)(size_t, size_t);
  void (*release)(void *);
  void (*finished)(void *, int);
  void *environment;
} Callbacks;

static void say(void *environment, const char *name, int status, const char *category, const char *text, ...) {
  (void)environment, (void)name, (void)category;
  if (status > 1) fprintf(stderr, "%s\n", text);
}

static double now(void) {
  struct timespec time;
  clock_gettime(CLOCK_MONOTONIC, &time);
  return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static long in_use(const char *what) {
  char line[256];
  long found = 0;
  FILE *file = fopen("/proc/self/status", "r");
  while (file && fgets(line, sizeof line, file))
    if (strncmp(line, what, strlen(what)) == 0) found = atol(line + strlen(what));
  if (file) fclose(file);
  return found;
}

static void *find(void *library, const char *name) {
  void *found = dlsym(library, name);
  if (!found) {
    fprintf(stderr, "no %s\n", name);
    exit(1);
  }
  return found;
}

static void expect(int status, const char *what) {
  if (status > 1) {
    fprintf(stderr, "%s answers %d\n", what, status);
    exit(1);
  }
}

int main(int argc, char **argv) {
  if (argc < 7) return 1;
  void *library = dlopen(argv[1], RTLD_NOW);
  if (!library) return 1;
  const double step = atof(argv[4]);
  const int steps = atoi(argv[5]), inputs = atoi(argv[6]), outputs = argc - 7 - 2 * inputs;
  unsigned in[MOST], out[MOST];
  double value[MOST], now_set[MOST], read[MOST];
  if (inputs > MOST || outputs < 0 || outputs > MOST) return 1;
  for (int i = 0; i < inputs; i++) in[i] = (unsigned)atol(argv[7 + 2 * i]), value[i] = atof(argv[8 + 2 * i]);
  for (int i = 0; i < outputs; i++) out[i] = (unsigned)atol(argv[7 + 2 * inputs + i]);

  Unit (*instantiate)(const char *, int, const char *, const char *, const Callbacks *, int, int) =
      (Unit(*)(const char *, int, const char *, const char *, const Callbacks *, int, int))find(library, "fmi2Instantiate");
  int (*setup)(Unit, int, double, double, int, double) =
      (int (*)(Unit, int, double, double, int, double))find(library, "fmi2SetupExperiment");
  Simple enter = (Simple)find(library, "fmi2EnterInitializationMode");
  Simple leave = (Simple)find(library, "fmi2ExitInitializationMode");
  int (*set)(Unit, const unsigned *, size_t, const double *) =
      (int (*)(Unit, const unsigned *, size_t, const double *))find(library, "fmi2SetReal");
  int (*get)(Unit, const unsigned *, size_t, double *) =
      (int (*)(Unit, const unsigned *, size_t, double *))find(library, "fmi2GetReal");
  int (*advance)(Unit, double, double, int) = (int (*)(Unit, double, double, int))find(library, "fmi2DoStep");

  const Callbacks callbacks = {say, calloc, free, NULL, NULL};
  const long before = in_use("VmRSS:");
  double begin = now();
  Unit unit = instantiate("timed", 1, argv[3], argv[2], &callbacks, 0, 1);
  if (!unit) return 1;
  expect(setup(unit, 0, 0.0, 0.0, 0, 0.0), "fmi2SetupExperiment");
  expect(enter(unit), "fmi2EnterInitializationMode");
  expect(leave(unit), "fmi2ExitInitializationMode");
  if (outputs) expect(get(unit, out, (size_t)outputs, read), "fmi2GetReal");
  const double started = now() - begin;

  double time = 0.0, least[2] = {1e9, 1e9};
  for (int timing = 0; timing < 2 * TIMINGS; timing++) {
    const int reads = timing % 2;
    begin = now();
    for (int n = 0; n < steps; n++) {
      if (n % HELD == 0 && inputs) {
        for (int i = 0; i < inputs; i++) now_set[i] = value[i] * (double)((n / HELD * (3 + 2 * i)) % 7) / 7.0;
        expect(set(unit, in, (size_t)inputs, now_set), "fmi2SetReal");
      }
      expect(advance(unit, time, step, 1), "fmi2DoStep");
      time += step;
      if (reads) expect(get(unit, out, (size_t)outputs, read), "fmi2GetReal");
    }
    const double spent = (now() - begin) / steps;
    if (spent < least[reads]) least[reads] = spent;
  }
  printf("%.6e %.6e %.6e %ld %ld %ld\n", started, least[0], least[1], before, in_use("VmRSS:"), in_use("VmHWM:"));
  return 0;
}
