# A kernel a job; those that meet the specimen in a variant for each traversal.
foreach(job forward_illumination forward_imaging probe_paths)
  vkfv_kernel(${job}_quadtree ${job}.comp)
  vkfv_kernel(${job}_ray_query ${job}.comp VKFV_RAY_QUERY)
endforeach()
vkfv_kernel(trace_rays trace_rays.comp)
vkfv_kernel(probe_records probe_records.comp)
vkfv_kernel(probe_hits_quadtree probe_hits.comp)
vkfv_kernel(probe_hits_ray_query probe_hits.comp VKFV_RAY_QUERY)
