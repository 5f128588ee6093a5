/* Drives a unit the same way on Linux and on Windows, and prints the bits of its outputs.
 *
 * The argument is a file of lines `key value …` in UTF-8, whose path is ASCII:
 *   library PATH     resources URI-OR-PATH   guid TEXT   version 2|3   step SECONDS   steps COUNT
 *   input REFERENCE COUNT VALUE              start value of an input, of all its elements
 *   output REFERENCE COUNT                   printed after each step, a line of 16 hexadecimal digits each
 *   save PATH        writes the state in the middle of the run
 *   load PATH        begins there instead
 *   task run|threads|reload
 * Answers 0 if all is as it should be.
 */
#include <impinge.h>
#include <impinge_fmi3.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
/* Needs the above. */
#include <psapi.h>
#else
#include <dlfcn.h>
#include <pthread.h>
#endif

#define EXPECT(condition)                                                  \
  do {                                                                     \
    if (!(condition)) {                                                    \
      fprintf(stderr, "%s:%d: %s\n", __FILE__, __LINE__, #condition);      \
      exit(1);                                                             \
    }                                                                      \
  } while (0)

enum { THREADS = 4, RELOADS = 60, SETTLED = 20, MOST = 1 << 16, LONGEST = 4096 };

typedef struct {
  unsigned reference;
  size_t count;
  double value;
} Variable;

static char library_path[LONGEST], resources[LONGEST], guid[LONGEST], task[LONGEST];
static char save_path[LONGEST], load_path[LONGEST];
static int version, steps, inputs, outputs;
static double step;
static Variable input[MOST], output[MOST];

/* --- What the systems do in ways of their own --- */

#ifdef _WIN32

static HMODULE library;

static void load_library(void) {
  wchar_t wide[LONGEST];
  EXPECT(MultiByteToWideChar(CP_UTF8, MB_ERR_INVALID_CHARS, library_path, -1, wide, LONGEST) > 0);
  library = LoadLibraryW(wide);
  if (library == NULL) {
    fprintf(stderr, "%s cannot be loaded: error %lu\n", library_path, GetLastError());
    exit(1);
  }
}

static void unload_library(void) {
  wchar_t wide[LONGEST];
  MultiByteToWideChar(CP_UTF8, 0, library_path, -1, wide, LONGEST);
  EXPECT(GetModuleHandleW(wide) == library);
  EXPECT(FreeLibrary(library));
  EXPECT(GetModuleHandleW(wide) == NULL);
}

static void *find(const char *name) { return (void *)GetProcAddress(library, name); }

static size_t memory(void) {
  PROCESS_MEMORY_COUNTERS_EX counters;
  EXPECT(GetProcessMemoryInfo(GetCurrentProcess(), (PROCESS_MEMORY_COUNTERS *)&counters,
                              sizeof counters));
  return counters.PrivateUsage;
}

typedef HANDLE Thread;
static DWORD WINAPI begin_thread(void *body) {
  ((void (*)(void))body)();
  return 0;
}
static Thread start(void (*body)(void)) { return CreateThread(NULL, 0, begin_thread, body, 0, NULL); }
static void join(Thread thread) {
  EXPECT(WaitForSingleObject(thread, INFINITE) == WAIT_OBJECT_0);
  CloseHandle(thread);
}

#else

static void *library;

static void load_library(void) {
  library = dlopen(library_path, RTLD_NOW | RTLD_LOCAL);
  if (library == NULL) {
    fprintf(stderr, "%s\n", dlerror());
    exit(1);
  }
}

static void unload_library(void) { EXPECT(dlclose(library) == 0); }

static void *find(const char *name) { return dlsym(library, name); }

static size_t memory(void) {
  size_t pages = 0;
  FILE *sizes = fopen("/proc/self/statm", "r");
  EXPECT(fscanf(sizes, "%*u %*u %*u %*u %*u %zu", &pages) == 1);
  fclose(sizes);
  return pages * 4096;
}

typedef pthread_t Thread;
static void *begin_thread(void *body) {
  (*(void (**)(void))body)();
  return NULL;
}
static Thread start(void (*body)(void)) {
  static void (*kept)(void);
  Thread thread;
  kept = body;
  EXPECT(pthread_create(&thread, NULL, begin_thread, &kept) == 0);
  return thread;
}
static void join(Thread thread) { EXPECT(pthread_join(thread, NULL) == 0); }

#endif

/* --- One run --- */

#define FUNCTION(name) ((__typeof__(name) *)find(#name))

static void listen2(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                    fmi2String category, fmi2String message, ...) {
  (void)environment, (void)instance, (void)category;
  if (status >= fmi2Error) {
    fprintf(stderr, "%s\n", message);
  }
}

static void listen3(fmi3InstanceEnvironment environment, fmi3Status status, fmi3String category,
                    fmi3String message) {
  (void)environment, (void)category;
  if (status >= fmi3Error) {
    fprintf(stderr, "%s\n", message);
  }
}

static void *instantiate(void) {
  static const fmi2CallbackFunctions callbacks = {listen2, NULL, NULL, NULL, NULL};
  void *unit;
  if (version == 2) {
    unit = FUNCTION(fmi2Instantiate)("drive", fmi2CoSimulation, guid, resources, &callbacks, 0, 0);
    EXPECT(unit != NULL);
    EXPECT(FUNCTION(fmi2SetupExperiment)(unit, 0, 0.0, 0.0, 0, 0.0) == fmi2OK);
  } else {
    unit = FUNCTION(fmi3InstantiateCoSimulation)("drive", guid, resources, false, false, false,
                                                 false, NULL, 0, NULL, listen3, NULL);
    EXPECT(unit != NULL);
  }
  return unit;
}

static void set(void *unit, const Variable *variable) {
  double *values = malloc(variable->count * sizeof *values);
  EXPECT(values != NULL);
  for (size_t i = 0; i < variable->count; i++) {
    values[i] = variable->value;
  }
  if (version == 2) {
    EXPECT(FUNCTION(fmi2SetReal)(unit, &variable->reference, 1, values) == fmi2OK);
  } else {
    EXPECT(FUNCTION(fmi3SetFloat64)(unit, &variable->reference, 1, values, variable->count) ==
           fmi3OK);
  }
  free(values);
}

static void *begin(void) {
  void *unit = instantiate();
  for (int i = 0; i < inputs; i++) {
    set(unit, &input[i]);
  }
  if (version == 2) {
    EXPECT(FUNCTION(fmi2EnterInitializationMode)(unit) == fmi2OK);
    EXPECT(FUNCTION(fmi2ExitInitializationMode)(unit) == fmi2OK);
  } else {
    EXPECT(FUNCTION(fmi3EnterInitializationMode)(unit, false, 0.0, 0.0, false, 0.0) == fmi3OK);
    EXPECT(FUNCTION(fmi3ExitInitializationMode)(unit) == fmi3OK);
  }
  return unit;
}

static void do_step(void *unit, int k) {
  if (version == 2) {
    EXPECT(FUNCTION(fmi2DoStep)(unit, k * step, step, 0) <= fmi2Warning);
  } else {
    bool event, end, early;
    double reached;
    EXPECT(FUNCTION(fmi3DoStep)(unit, k * step, step, false, &event, &end, &early, &reached) <=
           fmi3Warning);
  }
}

/* All outputs, one after the other; returns their number. */
static size_t read_outputs(void *unit, double *values) {
  size_t all = 0;
  for (int i = 0; i < outputs; all += output[i++].count) {
    const unsigned *reference = &output[i].reference;
    if (version == 2) {
      EXPECT(FUNCTION(fmi2GetReal)(unit, reference, 1, values + all) <= fmi2Warning);
    } else {
      EXPECT(FUNCTION(fmi3GetFloat64)(unit, reference, 1, values + all, output[i].count) <=
             fmi3Warning);
    }
  }
  return all;
}

static void save(void *unit) {
  void *state = NULL;
  size_t size = 0;
  EXPECT(FUNCTION(fmi2GetFMUstate)(unit, &state) == fmi2OK);
  EXPECT(FUNCTION(fmi2SerializedFMUstateSize)(unit, state, &size) == fmi2OK);
  char *bytes = malloc(size);
  EXPECT(FUNCTION(fmi2SerializeFMUstate)(unit, state, bytes, size) == fmi2OK);
  EXPECT(FUNCTION(fmi2FreeFMUstate)(unit, &state) == fmi2OK);
  FILE *file = fopen(save_path, "wb");
  EXPECT(file != NULL && fwrite(bytes, 1, size, file) == size && fclose(file) == 0);
  free(bytes);
}

static void restore(void *unit) {
  FILE *file = fopen(load_path, "rb");
  EXPECT(file != NULL && fseek(file, 0, SEEK_END) == 0);
  const size_t size = (size_t)ftell(file);
  rewind(file);
  char *bytes = malloc(size);
  EXPECT(fread(bytes, 1, size, file) == size && fclose(file) == 0);
  void *state = NULL;
  EXPECT(FUNCTION(fmi2DeSerializeFMUstate)(unit, bytes, size, &state) == fmi2OK);
  EXPECT(FUNCTION(fmi2SetFMUstate)(unit, state) == fmi2OK);
  EXPECT(FUNCTION(fmi2FreeFMUstate)(unit, &state) == fmi2OK);
  free(bytes);
}

static size_t count(void) {
  size_t all = 0;
  for (int i = 0; i < outputs; i++) {
    all += output[i].count;
  }
  return all;
}

/* Outputs after each step, in a block that the caller frees. */
static double *live(void) {
  double *values = calloc((size_t)steps, count() * sizeof *values);
  EXPECT(values != NULL);
  void *unit = begin();
  const int middle = steps / 2;
  if (load_path[0] != 0) {
    restore(unit);
  }
  for (int k = load_path[0] != 0 ? middle : 0; k < steps; k++) {
    if (k == middle && save_path[0] != 0) {
      save(unit);
    }
    do_step(unit, k);
    read_outputs(unit, values + (size_t)k * count());
  }
  if (version == 2) {
    EXPECT(FUNCTION(fmi2Terminate)(unit) == fmi2OK);
    FUNCTION(fmi2FreeInstance)(unit);
  } else {
    EXPECT(FUNCTION(fmi3Terminate)(unit) == fmi3OK);
    FUNCTION(fmi3FreeInstance)(unit);
  }
  return values;
}

static void print(const double *values) {
  for (int k = 0; k < steps; k++) {
    for (size_t i = 0; i < count(); i++) {
      unsigned long long bits;
      memcpy(&bits, values++, sizeof bits);
      printf("%016llx\n", bits);
    }
  }
}

/* --- The tasks --- */

static double *expected;

static void live_as_expected(void) {
  double *values = live();
  EXPECT(memcmp(values, expected, (size_t)steps * count() * sizeof *values) == 0);
  free(values);
}

static void on_threads(void) {
  Thread threads[THREADS];
  for (int i = 0; i < THREADS; i++) {
    threads[i] = start(live_as_expected);
  }
  for (int i = 0; i < THREADS; i++) {
    join(threads[i]);
  }
}

static void load_and_live(void) {
  load_library();
  live_as_expected();
  unload_library();
}

/* On this thread and on others, which end before or after the library is unloaded. */
static void reload(void) {
  size_t settled = 0;
  unload_library();
  for (int k = 0; k < RELOADS; k++) {
    if (k == SETTLED) {
      settled = memory();
    }
    if (k % 2 == 0) {
      load_and_live();
    } else {
      join(start(load_and_live));
    }
  }
  const size_t grown = memory() - settled;
  if ((ptrdiff_t)grown > 0) {
    fprintf(stderr, "%d loads take %zu bytes\n", RELOADS - SETTLED, grown);
  }
  EXPECT((ptrdiff_t)grown < 1 << 20);
  load_library();
}

static void read_job(const char *path) {
  char line[LONGEST + 64], key[32];
  FILE *file = fopen(path, "rb");
  EXPECT(file != NULL);
  while (fgets(line, sizeof line, file) != NULL) {
    int start = 0;
    line[strcspn(line, "\r\n")] = 0;
    EXPECT(sscanf(line, "%31s %n", key, &start) == 1);
    const char *rest = line + start;
    const struct {
      const char *key;
      char *text;
    } texts[] = {{"library", library_path}, {"resources", resources}, {"guid", guid},
                 {"task", task},            {"save", save_path},      {"load", load_path}};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
      if (strcmp(key, texts[i].key) == 0) {
        strcpy(texts[i].text, rest);
      }
    }
    if (strcmp(key, "version") == 0) {
      version = atoi(rest);
    } else if (strcmp(key, "steps") == 0) {
      steps = atoi(rest);
    } else if (strcmp(key, "step") == 0) {
      step = strtod(rest, NULL);
    } else if (strcmp(key, "input") == 0) {
      Variable *next = &input[inputs++];
      EXPECT(inputs < MOST && sscanf(rest, "%u %zu", &next->reference, &next->count) == 2);
      next->value = strtod(strrchr(rest, ' '), NULL);
    } else if (strcmp(key, "output") == 0) {
      Variable *next = &output[outputs++];
      EXPECT(outputs < MOST && sscanf(rest, "%u %zu", &next->reference, &next->count) == 2);
    }
  }
  fclose(file);
}

int main(int argc, char **argv) {
  EXPECT(argc == 2);
  read_job(argv[1]);
  load_library();
  expected = live();
  if (strcmp(task, "threads") == 0) {
    on_threads();
  } else if (strcmp(task, "reload") == 0) {
    reload();
  } else {
    EXPECT(strcmp(task, "run") == 0);
  }
  print(expected);
  unload_library();
  return 0;
}
