/*
 * The C interface of a unit: the functions of FMI 2.0 for co-simulation, with the types of the
 * standard's platform "default". Section numbers are those of FMI 2.0.4.
 */

#ifndef IMPINGE_H
#define IMPINGE_H

/* Made by cbindgen from the functions of src/fmi; a test keeps it so. */

#include <stddef.h>
typedef enum {
  fmi2OK,
  fmi2Warning,
  fmi2Discard,
  fmi2Error,
  fmi2Fatal,
  fmi2Pending
} fmi2Status;

typedef enum {
  fmi2ModelExchange,
  fmi2CoSimulation
} fmi2Type;

typedef enum {
  fmi2DoStepStatus,
  fmi2PendingStatus,
  fmi2LastSuccessfulTime,
  fmi2Terminated
} fmi2StatusKind;

typedef const char *fmi2String;

typedef void *fmi2Component;

typedef void *fmi2ComponentEnvironment;

typedef void (*fmi2CallbackLogger)(fmi2ComponentEnvironment,
                                   fmi2String,
                                   fmi2Status,
                                   fmi2String,
                                   fmi2String,
                                   ...);

typedef struct {
  fmi2CallbackLogger logger;
  void *(*allocateMemory)(size_t, size_t);
  void (*freeMemory)(void*);
  void (*stepFinished)(fmi2ComponentEnvironment, fmi2Status);
  fmi2ComponentEnvironment componentEnvironment;
} fmi2CallbackFunctions;

typedef int fmi2Boolean;

typedef double fmi2Real;

typedef unsigned int fmi2ValueReference;

typedef int fmi2Integer;

typedef void *fmi2FMUstate;

typedef char fmi2Byte;

typedef struct {
  fmi2Boolean newDiscreteStatesNeeded;
  fmi2Boolean terminateSimulation;
  fmi2Boolean nominalsOfContinuousStatesChanged;
  fmi2Boolean valuesOfContinuousStatesChanged;
  fmi2Boolean nextEventTimeDefined;
  fmi2Real nextEventTime;
} fmi2EventInfo;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

fmi2String fmi2GetTypesPlatform(void);

fmi2String fmi2GetVersion(void);

fmi2Component fmi2Instantiate(fmi2String instanceName,
                              int fmuType,
                              fmi2String guid,
                              fmi2String resourceLocation,
                              const fmi2CallbackFunctions *functions,
                              fmi2Boolean visible,
                              fmi2Boolean loggingOn);

void fmi2FreeInstance(fmi2Component component);

fmi2Status fmi2SetDebugLogging(fmi2Component component,
                               fmi2Boolean loggingOn,
                               size_t count,
                               const fmi2String *categories);

fmi2Status fmi2SetupExperiment(fmi2Component component,
                               fmi2Boolean toleranceDefined,
                               fmi2Real tolerance,
                               fmi2Real start,
                               fmi2Boolean stopDefined,
                               fmi2Real stop);

fmi2Status fmi2EnterInitializationMode(fmi2Component component);

fmi2Status fmi2ExitInitializationMode(fmi2Component component);

fmi2Status fmi2Terminate(fmi2Component component);

fmi2Status fmi2Reset(fmi2Component component);

fmi2Status fmi2GetReal(fmi2Component component,
                       const fmi2ValueReference *references,
                       size_t count,
                       fmi2Real *values);

fmi2Status fmi2GetInteger(fmi2Component component,
                          const fmi2ValueReference *references,
                          size_t count,
                          fmi2Integer *values);

fmi2Status fmi2GetBoolean(fmi2Component component,
                          const fmi2ValueReference *references,
                          size_t count,
                          fmi2Boolean *values);

fmi2Status fmi2GetString(fmi2Component component,
                         const fmi2ValueReference *references,
                         size_t count,
                         fmi2String *values);

fmi2Status fmi2SetReal(fmi2Component component,
                       const fmi2ValueReference *references,
                       size_t count,
                       const fmi2Real *values);

fmi2Status fmi2SetInteger(fmi2Component component,
                          const fmi2ValueReference *references,
                          size_t count,
                          const fmi2Integer *values);

fmi2Status fmi2SetBoolean(fmi2Component component,
                          const fmi2ValueReference *references,
                          size_t count,
                          const fmi2Boolean *values);

fmi2Status fmi2SetString(fmi2Component component,
                         const fmi2ValueReference *references,
                         size_t count,
                         const fmi2String *values);

fmi2Status fmi2GetFMUstate(fmi2Component component, fmi2FMUstate *state);

fmi2Status fmi2SetFMUstate(fmi2Component component, fmi2FMUstate state);

fmi2Status fmi2FreeFMUstate(fmi2Component component, fmi2FMUstate *state);

fmi2Status fmi2SerializedFMUstateSize(fmi2Component component, fmi2FMUstate state, size_t *size);

fmi2Status fmi2SerializeFMUstate(fmi2Component component,
                                 fmi2FMUstate state,
                                 fmi2Byte *bytes,
                                 size_t size);

fmi2Status fmi2DeSerializeFMUstate(fmi2Component component,
                                   const fmi2Byte *bytes,
                                   size_t size,
                                   fmi2FMUstate *state);

fmi2Status fmi2GetDirectionalDerivative(fmi2Component component,
                                        const fmi2ValueReference *unknowns,
                                        size_t unknownCount,
                                        const fmi2ValueReference *knowns,
                                        size_t knownCount,
                                        const fmi2Real *knownChanges,
                                        fmi2Real *unknownChanges);

fmi2Status fmi2SetRealInputDerivatives(fmi2Component component,
                                       const fmi2ValueReference *references,
                                       size_t count,
                                       const fmi2Integer *orders,
                                       const fmi2Real *values);

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component component,
                                        const fmi2ValueReference *references,
                                        size_t count,
                                        const fmi2Integer *orders,
                                        fmi2Real *values);

fmi2Status fmi2DoStep(fmi2Component component,
                      fmi2Real point,
                      fmi2Real step,
                      fmi2Boolean noSetStatePriorToCurrentPoint);

fmi2Status fmi2GetRealStatus(fmi2Component component, int kind, fmi2Real *value);

fmi2Status fmi2GetStatus(fmi2Component component, int kind, fmi2Status *value);

fmi2Status fmi2GetIntegerStatus(fmi2Component component, int kind, fmi2Integer *value);

fmi2Status fmi2GetBooleanStatus(fmi2Component component, int kind, fmi2Boolean *value);

fmi2Status fmi2GetStringStatus(fmi2Component component, int kind, fmi2String *value);

fmi2Status fmi2CancelStep(fmi2Component component);

fmi2Status fmi2EnterEventMode(fmi2Component component);

fmi2Status fmi2NewDiscreteStates(fmi2Component component, fmi2EventInfo *eventInfo);

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component component);

fmi2Status fmi2CompletedIntegratorStep(fmi2Component component,
                                       fmi2Boolean noSetStatePriorToCurrentPoint,
                                       fmi2Boolean *enterEventMode,
                                       fmi2Boolean *terminateSimulation);

fmi2Status fmi2SetTime(fmi2Component component, fmi2Real time);

fmi2Status fmi2SetContinuousStates(fmi2Component component, const fmi2Real *states, size_t count);

fmi2Status fmi2GetDerivatives(fmi2Component component, fmi2Real *derivatives, size_t count);

fmi2Status fmi2GetEventIndicators(fmi2Component component, fmi2Real *indicators, size_t count);

fmi2Status fmi2GetContinuousStates(fmi2Component component, fmi2Real *states, size_t count);

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component component,
                                             fmi2Real *nominals,
                                             size_t count);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* IMPINGE_H */
