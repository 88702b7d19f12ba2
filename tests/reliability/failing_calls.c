// Makes the k-th call of one kind fail in a program that this is loaded before (LD_PRELOAD): write, fsync, rename, mkdir
// on files other than standard output and error, or an allocation. FAIL_CALL names the kind, FAIL_AT the call, from 1
// (0: none), FAIL_FOREVER=1: all from there on. COUNT_FILE gets the number of calls when the program ends.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum kind { kind_none, kind_write, kind_fsync, kind_rename, kind_mkdir, kind_memory };

static enum kind failing;
static long at;
static int forever;
static atomic_long calls;

extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static int fails(enum kind kind)
{
    if (kind != failing) return 0;
    const long k = atomic_fetch_add(&calls, 1) + 1;
    return at > 0 && (forever ? k >= at : k == at);
}

__attribute__((constructor)) static void begin(void)
{
    static const char* const names[] = {"", "write", "fsync", "rename", "mkdir", "memory"};
    const char *name = getenv("FAIL_CALL"), *which = getenv("FAIL_AT"), *all = getenv("FAIL_FOREVER");
    at = which != NULL ? atol(which) : 0;
    forever = all != NULL && *all == '1';
    for (int k = kind_write; name != NULL && k <= kind_memory; ++k)
        if (strcmp(name, names[k]) == 0) failing = (enum kind)k;
}

__attribute__((destructor)) static void end(void)
{
    const char* file = getenv("COUNT_FILE");
    failing = kind_none;
    if (file == NULL) return;
    FILE* out = fopen(file, "w");
    if (out == NULL) return;
    fprintf(out, "%ld\n", atomic_load(&calls));
    fclose(out);
}

ssize_t write(int descriptor, const void* bytes, size_t count)
{
    static ssize_t (*real)(int, const void*, size_t);
    if (real == NULL) real = (ssize_t(*)(int, const void*, size_t))dlsym(RTLD_NEXT, "write");
    if (descriptor > 2 && fails(kind_write)) {
        errno = ENOSPC;
        return -1;
    }
    return real(descriptor, bytes, count);
}

int fsync(int descriptor)
{
    static int (*real)(int);
    if (real == NULL) real = (int (*)(int))dlsym(RTLD_NEXT, "fsync");
    if (fails(kind_fsync)) {
        errno = EIO;
        return -1;
    }
    return real(descriptor);
}

int rename(const char* from, const char* to)
{
    static int (*real)(const char*, const char*);
    if (real == NULL) real = (int (*)(const char*, const char*))dlsym(RTLD_NEXT, "rename");
    if (fails(kind_rename)) {
        errno = EACCES;
        return -1;
    }
    return real(from, to);
}

int mkdir(const char* path, mode_t mode)
{
    static int (*real)(const char*, mode_t);
    if (real == NULL) real = (int (*)(const char*, mode_t))dlsym(RTLD_NEXT, "mkdir");
    if (fails(kind_mkdir)) {
        errno = EACCES;
        return -1;
    }
    return real(path, mode);
}

void* malloc(size_t size)
{
    if (fails(kind_memory)) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_malloc(size);
}

void* calloc(size_t count, size_t size)
{
    if (fails(kind_memory)) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_calloc(count, size);
}

void* realloc(void* old, size_t size)
{
    if (fails(kind_memory)) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_realloc(old, size);
}

void* aligned_alloc(size_t alignment, size_t size)
{
    if (fails(kind_memory)) {
        errno = ENOMEM;
        return NULL;
    }
    return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, size_t alignment, size_t size)
{
    if (fails(kind_memory)) return ENOMEM;
    *memory = __libc_memalign(alignment, size);
    return *memory == NULL ? ENOMEM : 0;
}
