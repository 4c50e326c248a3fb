// Loaded before a program (LD_PRELOAD): METIS gets the program a SIGTERM and never returns.
#include <signal.h>
#include <unistd.h>

int cholmod_metis(void) {
  raise(SIGTERM);
  for (;;) pause();
}
