#!/bin/sh
# All shards of a campaign by GNU parallel on the hosts in the file beside this, then their gathering. Called by
#   sh @script@
# Called again, it goes on.
set -u
folder=@folder@
shards=@shards@
retries=@tries@
joblog=@joblog@
shard_call=@shard_call@
log="$folder/joblog-$joblog"
eta=
[ ! -t 2 ] || eta=--eta
interrupted=
trap 'interrupted=yes' INT TERM
rm -f -- "$folder/bad"
shard=0
while [ "$shard" -lt "$shards" ]; do
    printf '%s %s\n' "$shard_call" "$shard"
    shard=$((shard + 1))
done | PARALLEL_SHELL=/bin/sh parallel --will-cite --sshloginfile "$folder/hosts" --joblog "$log" --resume-failed \
    --retries "$retries" --termseq TERM,20000,TERM,10000,KILL,100 $eta
failed=$?
[ -z "$interrupted" ] || exit 75
[ ! -e "$folder/bad" ] || exit 2
@gather@
gathered=$?
[ "$failed" -eq 0 ] || {
    printf 'shards failed; see %s\n' "$log" >&2
    exit 1
}
exit "$gathered"
