#define _GNU_SOURCE // sigaction
#include "run/interrupt.h"

#include <signal.h>
#include <string.h>
#include <unistd.h>

static volatile sig_atomic_t received;

static void on_signal(int number) {
  static const char text[] =
      "\nphotonlab: finishing the blocks at work, then stopping (again: at once, without them)\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) received = number; // nobody to tell
  received = number;
  signal(number, SIG_DFL);
}

void interrupt_install(void) {
  struct sigaction action;
  memset(&action, 0, sizeof action);
  action.sa_handler = on_signal;
  action.sa_flags = SA_RESTART; // what is being written is written to its end
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

int interrupt_signal(void) { return received; }
