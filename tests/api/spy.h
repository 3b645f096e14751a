/* A spy between the library and Vulkan: it counts what the library calls, keeps the list of objects that are alive,
 * lets chosen calls fail and chosen barriers vanish. One for the whole process; the counters are safe to use from
 * threads. */
#ifndef API_SPY_H
#define API_SPY_H

#include <stdbool.h>
#include <stdint.h>

#include <volk.h>

typedef struct spy_counts {
    unsigned commands;  /* vkCmd* */
    unsigned barriers;  /* of these, vkCmdPipelineBarrier, dropped ones included */
    unsigned updates;   /* vkUpdateDescriptorSets */
    unsigned creations; /* vkCreate*, vkAllocate* and vkBind*: everything that can fail */
    unsigned alive;     /* objects created and not destroyed */
    unsigned strangers; /* destructions of what was not alive */
    unsigned forbidden; /* functions asked for that submit or wait */
} spy_counts;

/* Give these to the library in place of the real ones. */
PFN_vkVoidFunction VKAPI_CALL spy_get_instance_proc_addr(VkInstance instance, const char *name);
PFN_vkVoidFunction VKAPI_CALL spy_get_device_proc_addr(VkDevice device, const char *name);

spy_counts spy_read(void);

/* The call number `k` from now on, from 1, of those that can fail fails with `result`, leaving garbage in what it
 * should have created. 0: none. */
void spy_fail(unsigned k, VkResult result);
/* Name of the call that failed since the last spy_fail; NULL if none did. */
const char *spy_failed_call(void);
/* One function that the proc-addr functions do not know; NULL: they know all. The string is kept. */
void spy_hide(const char *name);

/* Drops `count` barriers from number `first` on, counted from now on, from 0. */
void spy_drop_barriers(unsigned first, unsigned count);
/* What followed barrier number `k`: a pass's label or a command's name. */
const char *spy_after_barrier(unsigned k);

/* Allocation callbacks that count, and that return NULL for the library's allocation number `k` from now on, from 1;
 * what the driver allocates is not counted for that. */
const VkAllocationCallbacks *spy_allocator(void);
void spy_fail_host(unsigned k);
bool spy_host_failed(void);
unsigned spy_host_alive(void); /* allocations not freed */

#endif
