// SIGINT and SIGTERM ask a run to finish the blocks it is at; a second one ends it at once.
#ifndef RUN_INTERRUPT_H
#define RUN_INTERRUPT_H

void interrupt_install(void);
int interrupt_signal(void); // 0: none yet; the exit status is 128 + this

#endif
