// How many threads there are, and how they wait.
#ifndef BASE_THREADS_H
#define BASE_THREADS_H

// That work is shared out to unless the user says how many.
int threads_available(void);

#endif
